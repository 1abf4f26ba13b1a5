#include "kinequad/field/cross_field_targets.h"

#include <gtest/gtest.h>

#include <numbers>

#include "field/surfaces.h"
#include "kinequad/core/error.h"

namespace kinequad {
namespace {

using test::Surface;
using test::surface_of;

/// Tensors of a square of two triangles, all set by hand.
DeformationTensors two_triangles() {
    DeformationTensors tensors;
    tensors.frame_count = 4;
    tensors.curvature.resize(2);
    tensors.curvature << Complex(0, 0.4), Complex(0, 0);
    tensors.stretch_direction_sum.resize(2);
    tensors.stretch_direction_sum << Complex(0, 3), Complex(-1, 0);
    tensors.stretch_sum = Eigen::Vector2d(4, 0.2);
    tensors.stretch_square_sum = Eigen::Vector2d(4, 0.02);
    return tensors;
}

CrossFieldTargets targets_of(const CrossFieldTargetOptions& options) {
    const Surface square = surface_of(test::square(1));
    return compute_cross_field_targets(square.topology, square.metric, two_triangles(), options);
}

TEST(CrossFieldTargets, AreBoundedStretchAndCurvatureInTheirProportions) {
    const CrossFieldTargets targets =
        targets_of({.alpha = 0.7, .curvature_weight = 0.1, .edge_length = 0.5});
    // The mean stretches over four frames are 3i/4 and -1/4, bounded 3i/7 and -1/5.
    const Complex first(0, 0.3 + 0.04);
    // Area 1/2, edge length 1/2: four times two.
    EXPECT_NEAR(targets.weight[0], 8 * std::abs(first), 1e-12);
    EXPECT_NEAR(std::abs(targets.value[0] - first / std::abs(first)), 0, 1e-12);
    EXPECT_NEAR(targets.weight[1], 8 * 0.7 / 5, 1e-12);
    EXPECT_NEAR(std::abs(targets.value[1] - Complex(-1, 0)), 0, 1e-12);
}

TEST(CrossFieldTargets, GrowWithTheStretchButNotBeyondAlpha) {
    const Surface square = surface_of(test::square(1));
    DeformationTensors tensors;
    tensors.frame_count = 1;
    double last = 0;
    for (const double stretch : {0.1, 1.0, 10.0, 1e6}) {
        tensors.stretch_direction_sum = Eigen::VectorXcd::Constant(2, Complex(0, stretch));
        const CrossFieldTargets targets = compute_cross_field_targets(
            square.topology, square.metric, tensors, {.alpha = 0.5, .edge_length = 1});
        EXPECT_GT(targets.weight[0], last);
        last = targets.weight[0];
    }
    EXPECT_NEAR(last, 4 * 0.5 * 0.5, 1e-5);  // area 1/2, alpha 1/2
}

TEST(CrossFieldTargets, AtAlphaZeroKnowNothingOfTheAnimation) {
    const CrossFieldTargets targets = targets_of({.alpha = 0, .edge_length = 1});
    EXPECT_NEAR(std::abs(targets.value[0] - Complex(0, 1)), 0, 1e-12);
    EXPECT_EQ(targets.weight[1], 0);
    const CrossFieldTargets paper = targets_of({.method = CrossFieldMethod::paper, .alpha = 0});
    EXPECT_EQ(paper.weight.cwiseAbs().maxCoeff(), 0);
}

TEST(CrossFieldTargets, OfThePaperAreItsEquations) {
    // The mean stretches are 1 and 0.1.
    const auto weights = [](double smallest, double largest) {
        return targets_of({.method = CrossFieldMethod::paper,
                           .alpha = 0.75,
                           .smallest_stretch = smallest,
                           .largest_stretch = largest})
            .weight;
    };
    const CrossFieldTargets targets =
        targets_of({.method = CrossFieldMethod::paper, .alpha = 0.75});
    EXPECT_NEAR(std::abs(targets.value[0] - Complex(0, 1)), 0, 1e-12);
    EXPECT_NEAR(targets.weight[0], 3 * (1 - 0.5) / (2 - 0.5), 1e-12);
    EXPECT_EQ(targets.weight[1], 0);
    EXPECT_NEAR(weights(0, 4)[0], 3 * 0.25, 1e-12);
    EXPECT_EQ(weights(0, 4)[1], 0);  // 0.1 / 4 is below the least weight that counts
    EXPECT_NEAR(weights(0, 0.5)[0], 3, 1e-12);
    EXPECT_NEAR(weights(0, 0.5)[1], 3 * 0.2, 1e-12);
}

TEST(CrossFieldTargets, WeighTheSameOverallOnAFinerMesh) {
    const auto total = [](int n) {
        const Surface square = surface_of(test::square(n));
        DeformationTensors tensors;
        tensors.frame_count = 2;
        tensors.stretch_direction_sum =
            Eigen::VectorXcd::Constant(square.topology.triangle_count, 0.6);
        return compute_cross_field_targets(square.topology, square.metric, tensors,
                                           {.edge_length = 0.1})
            .weight.sum();
    };
    EXPECT_GT(total(3), 1);
    EXPECT_NEAR(total(3), total(20), 1e-9);
}

TEST(CrossFieldTargets, RefuseOptionsOutOfRange) {
    EXPECT_THROW(targets_of({.alpha = -0.1, .edge_length = 1}), InputError);
    EXPECT_THROW(targets_of({.edge_length = 0}), InputError);
    EXPECT_THROW(targets_of({.method = CrossFieldMethod::paper, .alpha = 1}), InputError);
    EXPECT_THROW(
        targets_of({.method = CrossFieldMethod::paper, .alpha = 0.5, .largest_stretch = 0.5}),
        InputError);
    EXPECT_THROW(
        targets_of({.method = CrossFieldMethod::paper, .alpha = 0.5, .smallest_stretch = -1}),
        InputError);
}

}  // namespace
}  // namespace kinequad
