#include "kinequad/mesh/line_walk.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinequad/mesh/pose_search.h"
#include "support/shapes.h"

namespace kinequad {
namespace {

/// Walks along the boundary of a flat square with corners at 0 and 1.
class SquareWalk : public testing::Test {
protected:
    SquareWalk()
        : mesh_(test::square(6)),
          topology_(build_topology(mesh_.F, static_cast<int>(mesh_.V.rows()))),
          metric_(metric_of(topology_, mesh_.V)),
          walk_(topology_, metric_, boundary_edges(topology_)) {}

    /// A point of the boundary with y = 0.
    SurfacePoint on_the_lower_side() const {
        for (int h = 0; h < 3 * topology_.triangle_count; ++h) {
            const int a = topology_.origin[static_cast<std::size_t>(h)];
            const int b = topology_.target(h);
            const bool is_there = topology_.twin[static_cast<std::size_t>(h)] < 0 &&
                                  std::abs(mesh_.V(a, 1) - low()) < 1e-9 &&
                                  std::abs(mesh_.V(b, 1) - low()) < 1e-9;
            if (!is_there) continue;
            SurfacePoint point{h / 3, Vector3::Zero()};
            point.barycentric[h % 3] = 0.5;
            point.barycentric[(h + 1) % 3 == 0 ? h % 3 - 2 : h % 3 + 1] = 0.5;
            return point;
        }
        return {};
    }
    double low() const { return mesh_.V.col(1).minCoeff(); }
    Vector3 place(const SurfacePoint& point) const { return position_of(point, mesh_.V, mesh_.F); }
    /// A step in space as a vector in the frame of the point's triangle; the square is flat.
    Vector2 step(const SurfacePoint& point, const Vector3& move) const {
        const auto row = mesh_.F.row(point.triangle);
        const Vector3 x = (mesh_.V.row(row[1]) - mesh_.V.row(row[0])).transpose().normalized();
        const Vector3 y = Vector3::UnitZ().cross(x);
        return {move.dot(x), move.dot(y)};
    }

    TriangleMesh mesh_;
    Topology topology_;
    IntrinsicMetric metric_;
    LineWalk walk_;
};

TEST_F(SquareWalk, GoesAlongTheSideAndStopsAtTheCorner) {
    const SurfacePoint start = on_the_lower_side();
    ASSERT_GE(start.triangle, 0);
    EXPECT_TRUE(walk_.is_passed(start));
    const double size = mesh_.V.col(0).maxCoeff() - mesh_.V.col(0).minCoeff();
    const Vector3 from = place(start);
    for (const double way : {0.02 * size, 0.3 * size, -0.05 * size, 2 * size, -2 * size}) {
        const Vector3 end = place(walk_.walk(start, step(start, {way, 0.7, 0})));
        const double wanted =
            std::clamp(from[0] + way, mesh_.V.col(0).minCoeff(), mesh_.V.col(0).maxCoeff());
        EXPECT_NEAR(end[0], wanted, 1e-5 * size) << way;
        EXPECT_NEAR(end[1], low(), 1e-12) << "a line is never left";
    }
}

TEST_F(SquareWalk, NoWalkBeginsOffTheLineOrAtACorner) {
    EXPECT_EQ(walk_.edge_of({0, Vector3::Constant(1.0 / 3)}), -1);
    for (int v = 0; v < topology_.vertex_count; ++v) {
        const int h = topology_.vertex_half_edge[static_cast<std::size_t>(v)];
        const SurfacePoint vertex{h / 3, Vector3::Unit(h % 3)};
        const bool on_x = std::abs(mesh_.V(v, 0) - mesh_.V.col(0).minCoeff()) < 1e-9 ||
                          std::abs(mesh_.V(v, 0) - mesh_.V.col(0).maxCoeff()) < 1e-9;
        const bool on_y = std::abs(mesh_.V(v, 1) - low()) < 1e-9 ||
                          std::abs(mesh_.V(v, 1) - mesh_.V.col(1).maxCoeff()) < 1e-9;
        EXPECT_EQ(walk_.is_passed(vertex), on_x != on_y) << v;
    }
}

TEST(PoseSearch, FindsThePointThatAllPosesTogetherAreNearestTo) {
    const TriangleMesh mesh = test::sphere(3);
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    const std::vector<Positions> poses = {mesh.V, 2 * mesh.V};
    const PoseSearch search(topology, mesh.F, poses);
    for (int t = 0; t < topology.triangle_count; t += 37) {
        const SurfacePoint there{t, Vector3(0.2, 0.5, 0.3)};
        const SurfacePoint found =
            search.find(search.place(there), (t + 11) % topology.triangle_count);
        EXPECT_LT((position_of(found, mesh.V, mesh.F) - position_of(there, mesh.V, mesh.F)).norm(),
                  1e-9);
    }
}

}  // namespace
}  // namespace kinequad
