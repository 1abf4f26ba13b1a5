#include "kinequad/mesh/line_walk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

TEST_F(SquareWalk, BeginsAtAVertexInWhicheverTriangleThatIsNamed) {
    const double side = mesh_.V.col(0).maxCoeff() - mesh_.V.col(0).minCoeff();
    int without_edge = 0;
    for (int h = 0; h < 3 * topology_.triangle_count; ++h) {
        const SurfacePoint vertex{h / 3, Vector3::Unit(h % 3)};
        const SurfacePoint seated = walk_.seat(vertex);
        EXPECT_EQ(place(seated), place(vertex));
        if (!walk_.is_passed(vertex)) continue;
        const bool is_stuck = walk_.walk(vertex, {0.1 * side, 0.1 * side}) == vertex;
        EXPECT_EQ(seated == vertex, !is_stuck) << "what can walk is left as it is";
        without_edge += is_stuck ? 1 : 0;
        // One of the two goes along the side, whichever it is.
        double way = 0;
        for (const Vector3 move : {Vector3::UnitX(), Vector3::UnitY()}) {
            const SurfacePoint end = walk_.walk(seated, step(seated, 0.1 * side * move));
            way = std::max(way, (place(end) - place(vertex)).norm());
        }
        EXPECT_NEAR(way, 0.1 * side, 1e-4 * side);
    }
    EXPECT_GT(without_edge, 0);
    const SurfacePoint middle{0, Vector3::Constant(1.0 / 3)};
    EXPECT_EQ(walk_.seat(middle), middle);
}

TEST(LineWalk, EndsOnAClosedLineHoweverLongTheWay) {
    // A strip around an axis: both of its boundaries are closed lines of `sides` edges of length 1.
    constexpr int sides = 12;
    Triangles F(2 * sides, 3);
    for (int i = 0; i < sides; ++i) {
        const int j = (i + 1) % sides;
        F.row(2 * i) << i, j, sides + j;
        F.row(2 * i + 1) << i, sides + j, sides + i;
    }
    const Topology topology = build_topology(F, 2 * sides);
    IntrinsicMetric metric;
    metric.edge_length = Eigen::VectorXd::Ones(topology.edge_count);
    const LineWalk walk(topology, metric, boundary_edges(topology));
    // The frame of a triangle has its first side as axis: triangle 0 begins with side 0 to 1.
    for (const double way : {1e5, 1e9, std::numeric_limits<double>::infinity()}) {
        const SurfacePoint end = walk.walk({0, Vector3(0.5, 0.5, 0)}, {way, 0});
        EXPECT_EQ(end.triangle, 2 * (1000 % sides));
        EXPECT_NEAR(end.barycentric[1], 1, 1e-5) << "at the end of the edge";
    }
    const SurfacePoint around = walk.walk({0, Vector3(0.5, 0.5, 0)}, {10 * sides + 0.25, 0});
    EXPECT_EQ(around.triangle, 0);
    EXPECT_NEAR(around.barycentric[1], 0.75, 1e-9);
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
