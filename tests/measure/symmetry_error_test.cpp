#include "kinequad/measure/symmetry_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinequad/core/error.h"
#include "kinequad/mesh/intrinsic_metric.h"
#include "kinequad/symmetry/compute_mirror_map.h"
#include "quad_grid.h"
#include "support/shapes.h"

namespace kinequad {
namespace {

/// A square of triangles that x = 1/2 mirrors, and quads over it turned by `degrees`.
struct MirroredSquare {
    TriangleMesh square = test::square(8);
    Topology topology = build_topology(square.F, static_cast<int>(square.V.rows()));
    IntrinsicMetric metric = metric_of(topology, square.V);
    SymmetryMap map = compute_mirror_map(square, {Vector3::UnitX(), 0.5, 0}, metric, {});

    StretchReference under(const Positions& X, const Quads& Q) const {
        return {square.V, square.F, triangle_sides(topology, metric), X, make_polygons(Q)};
    }

    StretchReference under_turned_grid(double degrees) const {
        const test::QuadGrid grid = test::quad_grid(40);
        const double angle = degrees * std::numbers::pi / 180;
        const Eigen::RowVector3d middle(0.5, 0.5, 0);
        const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, Vector3::UnitZ()).toRotationMatrix();
        return under((2 * (grid.X.rowwise() - middle) * R.transpose()).rowwise() + middle, grid.Q);
    }
};

TEST(SymmetryError, IsTwiceTheTurnOfAGrid) {
    // A grid turned by a is mirrored to one turned by -a; crosses repeat after 90 degrees.
    const MirroredSquare shape;
    for (const auto& [turn, error] : {std::pair{0.0, 0.0},
                                      {5.0, 10.0},
                                      {-5.0, 10.0},
                                      {22.5, 45.0},
                                      {40.0, 10.0},
                                      {45.0, 0.0},
                                      {90.0, 0.0}}) {
        EXPECT_NEAR(measure_symmetry_error(shape.under_turned_grid(turn), shape.map), error, 1e-6)
            << turn;
    }
}

TEST(SymmetryError, IsTheMeanWhereOneSideDiffers) {
    // Straight on the left, turned by 20 degrees on the right: 20 degrees everywhere.
    const MirroredSquare shape;
    const StretchReference straight = shape.under_turned_grid(0);
    const StretchReference turned = shape.under_turned_grid(20);
    Positions X(straight.X.rows() + turned.X.rows(), 3);
    X << straight.X, turned.X;
    std::vector<std::array<int, 4>> kept;
    const auto keep = [&](const StretchReference& from, int offset, double sign) {
        for (int f = 0; f < from.faces.count(); ++f) {
            double x = 0;
            std::array<int, 4> quad{};
            for (std::size_t k = 0; k < 4; ++k) {
                quad[k] = from.faces[f][k] + offset;
                x += X(quad[k], 0) / 4;
            }
            if (sign * (x - 0.5) > 0) kept.push_back(quad);
        }
    };
    keep(straight, 0, -1);
    keep(turned, static_cast<int>(straight.X.rows()), 1);
    Quads Q(static_cast<Eigen::Index>(kept.size()), 4);
    for (Eigen::Index q = 0; q < Q.rows(); ++q) {
        const auto& corners = kept[static_cast<std::size_t>(q)];
        Q.row(q) << corners[0], corners[1], corners[2], corners[3];
    }
    EXPECT_NEAR(measure_symmetry_error(shape.under(X, Q), shape.map), 20, 1e-6);
}

TEST(SymmetryError, LeavesOutFacesThatAreNoQuads) {
    const MirroredSquare shape;
    StretchReference reference = shape.under_turned_grid(10);
    reference.faces = make_polygons(shape.square.F);
    reference.X = shape.square.V;
    EXPECT_TRUE(std::isnan(measure_symmetry_error(reference, shape.map)));
}

TEST(SymmetryError, DoesNotDependOnThreads) {
    const MirroredSquare shape;
    const StretchReference reference = shape.under_turned_grid(13);
    Context one;
    one.threads = 1;
    const double alone = measure_symmetry_error(reference, shape.map, one);
    EXPECT_EQ(measure_symmetry_error(reference, shape.map, {}), alone);
}

TEST(SymmetryError, RefusesTheMapOfAnotherMesh) {
    const MirroredSquare shape;
    SymmetryMap other = shape.map;
    other.centre_image.pop_back();
    EXPECT_THROW(measure_symmetry_error(shape.under_turned_grid(0), other), InputError);
}

}  // namespace
}  // namespace kinequad
