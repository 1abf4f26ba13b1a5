#include "kinequad/deformation/compute_deformation_tensors.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "deformation/moves.h"
#include "kinequad/core/error.h"
#include "kinequad/io/memory_sequence.h"
#include "support/shapes.h"

namespace kinequad {
namespace {

using test::moved_rigidly;
using test::stretched;

constexpr double pi = std::numbers::pi;

DeformationOptions every_stretch() {
    DeformationOptions options;
    options.stretch_quantile = 1;
    return options;
}

DeformationTensors tensors_of(const TriangleMesh& rest, std::vector<Positions> frames,
                              const DeformationOptions& options = every_stretch()) {
    const Topology topology = build_topology(rest.F, static_cast<int>(rest.V.rows()));
    return compute_deformation_tensors(MemorySequence(rest.F, std::move(frames)), topology,
                                       metric_of(topology, rest.V), options, {});
}

/// Direction of half-edge 0 of a triangle in the xy-plane, radians.
double frame_direction(const TriangleMesh& mesh, int t) {
    const Eigen::RowVector3d x = mesh.V.row(mesh.F(t, 1)) - mesh.V.row(mesh.F(t, 0));
    return std::atan2(x[1], x[0]);
}

double largest_difference(const Eigen::VectorXcd& a, const Eigen::VectorXcd& b) {
    return (a - b).cwiseAbs().maxCoeff();
}

TEST(DeformationTensors, OfAPureStretchAreItsFactorAndDirection) {
    rc::check([] {
        const double factor = 1 + *rc::gen::inRange(1, 400) / 100.0;
        const double angle = *rc::gen::inRange(0, 314) / 100.0;
        const TriangleMesh mesh = test::square(3);
        const DeformationTensors tensors =
            tensors_of(mesh, {moved_rigidly(stretched(mesh.V, factor, angle), 1.3)});
        for (int t = 0; t < mesh.F.rows(); ++t) {
            const Complex direction = std::polar(1.0, 4 * (angle - frame_direction(mesh, t)));
            RC_ASSERT(std::abs(tensors.stretch_sum[t] - (factor - 1)) < 1e-9);
            RC_ASSERT(std::abs(tensors.stretch_square_sum[t] - std::pow(factor - 1, 2)) < 1e-9);
            RC_ASSERT(std::abs(tensors.stretch_direction_sum[t] - (factor - 1) * direction) < 1e-9);
        }
    });
}

TEST(DeformationTensors, OfMotionsThatStretchNothingAreZero) {
    const TriangleMesh mesh = test::sphere(3);
    const DeformationTensors tensors =
        tensors_of(mesh, {mesh.V, moved_rigidly(mesh.V, 0.7), 2.5 * moved_rigidly(mesh.V, -2)});
    EXPECT_LT(tensors.stretch_direction_sum.cwiseAbs().maxCoeff(), 1e-6);
    EXPECT_LT(tensors.stretch_sum.maxCoeff(), 1e-6);
    EXPECT_EQ(tensors.curvature.cwiseAbs().maxCoeff(), 0);  // no edge length was given
}

TEST(DeformationTensors, OfCrossedStretchesAgreeAndOfDiagonalOnesCancel) {
    // A stretch along x and one along y are the same cross; one along the diagonal is the opposite.
    const TriangleMesh mesh = test::square(2);
    const Positions along = stretched(mesh.V, 2, 0);
    const Positions across = stretched(mesh.V, 2, pi / 2);
    const Positions diagonal = stretched(mesh.V, 2, pi / 4);
    const DeformationTensors agree = tensors_of(mesh, {along, across});
    const DeformationTensors cancel = tensors_of(mesh, {along, diagonal});
    EXPECT_NEAR(std::abs(agree.stretch_direction_sum[0]), 2, 1e-12);
    EXPECT_NEAR(std::abs(cancel.stretch_direction_sum[0]), 0, 1e-12);
    EXPECT_NEAR(cancel.stretch_sum[0], 2, 1e-12);
}

TEST(DeformationTensors, DoNotDependOnTheOrderOfTheFrames) {
    const TriangleMesh mesh = test::torus(20, 10);
    std::vector<Positions> frames;
    for (int j = 0; j < 7; ++j) frames.push_back(stretched(mesh.V, 1 + 0.2 * j, 0.5 * j));
    const DeformationTensors forward = tensors_of(mesh, frames);
    std::reverse(frames.begin(), frames.end());
    std::swap(frames[1], frames[4]);
    const DeformationTensors shuffled = tensors_of(mesh, frames);
    EXPECT_LT(largest_difference(forward.stretch_direction_sum, shuffled.stretch_direction_sum),
              1e-12);
}

TEST(DeformationTensors, TurnWithTheFrameOfTheTriangle) {
    const TriangleMesh mesh = test::torus(16, 9);
    const Positions frame = stretched(mesh.V, 1.7, 0.6);
    TriangleMesh rotated = mesh;
    for (int t = 0; t < mesh.F.rows(); ++t) {
        rotated.F.row(t) << mesh.F(t, 1), mesh.F(t, 2), mesh.F(t, 0);
    }
    const DeformationTensors tensors = tensors_of(mesh, {frame});
    const DeformationTensors turned = tensors_of(rotated, {frame});
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    const IntrinsicMetric metric = metric_of(topology, mesh.V);
    for (int t = 0; t < mesh.F.rows(); ++t) {
        const double turn = half_edge_directions(side_lengths(topology, metric, t))[1];
        const Complex expected = tensors.stretch_direction_sum[t] * std::polar(1.0, -4 * turn);
        EXPECT_LT(std::abs(turned.stretch_direction_sum[t] - expected), 1e-12);
    }
}

TEST(DeformationTensors, LeaveCollapsedTrianglesOut) {
    const TriangleMesh mesh = test::square(1);
    Positions collapsed = stretched(mesh.V, 2, 0);
    collapsed.row(mesh.F(1, 2)) = collapsed.row(mesh.F(1, 1));
    const DeformationTensors tensors = tensors_of(mesh, {stretched(mesh.V, 2, 0), collapsed});
    EXPECT_NEAR(tensors.stretch_sum[0], 2, 1e-12);
    EXPECT_NEAR(tensors.stretch_sum[1], 1, 1e-12);
}

TEST(DeformationTensors, OfATriangleThatTheMetricCollapsesAreZero) {
    TriangleMesh mesh = test::square(1);
    mesh.V.row(mesh.F(1, 2)) = mesh.V.row(mesh.F(1, 1));
    const DeformationTensors tensors = tensors_of(mesh, {test::square(1).V});
    EXPECT_TRUE(tensors.stretch_direction_sum.allFinite());
    EXPECT_EQ(tensors.stretch_direction_sum[1], Complex(0));
    EXPECT_EQ(tensors.stretch_sum[1], 0);
}

TEST(DeformationTensors, BoundTheStretchAtAQuantileAndSayWhere) {
    const TriangleMesh mesh = test::square(10);
    Positions frame = mesh.V;
    frame.row(12) += Eigen::RowVector3d(0.0999, 0, 0);  // slivers beside one vertex
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    std::vector<std::string> lines;
    Context context;
    context.log = [&](LogLevel, std::string_view line) { lines.emplace_back(line); };
    DeformationOptions options;
    options.stretch_quantile = 0.98;
    const DeformationTensors bounded = compute_deformation_tensors(
        MemorySequence(mesh.F, {frame}), topology, metric_of(topology, mesh.V), options, context);
    const double free_largest = tensors_of(mesh, {frame}).stretch_sum.maxCoeff();
    EXPECT_GT(free_largest, 100);
    EXPECT_LT(bounded.stretch_sum.maxCoeff(), 0.1 * free_largest);
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_NE(lines[0].find("0.98 quantile"), std::string::npos);
}

TEST(DeformationTensors, OfOneFrameAreThoseOfASequenceOfOne) {
    const TriangleMesh mesh = test::sphere(2);
    const std::vector<Positions> frames = {mesh.V, stretched(mesh.V, 2, 1),
                                           stretched(mesh.V, 3, 2)};
    DeformationOptions options = every_stretch();
    options.edge_length = 0.3;
    const DeformationTensors alone = tensors_of(mesh, {frames[1]}, options);
    options.only_frame = 1;
    const DeformationTensors chosen = tensors_of(mesh, frames, options);
    EXPECT_EQ(chosen.stretch_direction_sum, alone.stretch_direction_sum);
    EXPECT_EQ(chosen.curvature, alone.curvature);
    EXPECT_EQ(chosen.frame_count, 1);
}

TEST(DeformationTensors, SameBytesOnAnyNumberOfThreads) {
    const TriangleMesh mesh = test::torus(80, 60);
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    const MemorySequence frames(mesh.F, {mesh.V, stretched(mesh.V, 1.4, 1), 0.5 * mesh.V});
    DeformationOptions options;
    options.edge_length = 0.1;
    Context context;
    context.threads = 1;
    const IntrinsicMetric metric = metric_of(topology, mesh.V);
    const DeformationTensors one =
        compute_deformation_tensors(frames, topology, metric, options, context);
    for (const int threads : {2, 8}) {
        context.threads = threads;
        const DeformationTensors many =
            compute_deformation_tensors(frames, topology, metric, options, context);
        EXPECT_EQ(many.stretch_direction_sum, one.stretch_direction_sum);
        EXPECT_EQ(many.stretch_square_sum, one.stretch_square_sum);
        EXPECT_EQ(many.curvature, one.curvature);
    }
}

TEST(DeformationTensors, RefuseOptionsOutOfRange) {
    const TriangleMesh mesh = test::tetrahedron();
    const auto refused = [&](DeformationOptions options) {
        EXPECT_THROW(tensors_of(mesh, {mesh.V}, options), InputError);
    };
    refused({.edge_length = -1});
    refused({.curvature_frames = 0});
    refused({.stretch_quantile = 0});
    refused({.stretch_quantile = 1.5});
    refused({.only_frame = 1});
}

}  // namespace
}  // namespace kinequad
