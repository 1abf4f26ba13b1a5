#include "kinequad/mesh/check_mesh.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "kinequad/mesh/repair_mesh.h"
#include "support/shapes.h"

namespace kinequad::test {
namespace {

Triangles triangles(const std::vector<std::array<int, 3>>& rows) {
    Triangles F(static_cast<Eigen::Index>(rows.size()), 3);
    for (std::size_t t = 0; t < rows.size(); ++t) {
        F.row(static_cast<Eigen::Index>(t)) << rows[t][0], rows[t][1], rows[t][2];
    }
    return F;
}

/// Vertices that no three of which lie on one line.
Positions spread_vertices(int count) {
    Positions V(count, 3);
    for (int v = 0; v < count; ++v) V.row(v) << v, v * v % 7, v * v * v % 11;
    return V;
}

MeshReport check(const std::vector<std::array<int, 3>>& rows, int vertex_count) {
    return check_mesh(triangles(rows), spread_vertices(vertex_count), {}, {});
}

MeshDegeneracies none(const Triangles& F) {
    const auto m = static_cast<std::size_t>(F.rows());
    return {std::vector<char>(m, 0), std::vector<char>(3 * m, 0), std::vector<double>(3 * m, 1)};
}

MeshDegeneracies degeneracies_of(const Triangles& F, const Positions& V) {
    MeshDegeneracies result = none(F);
    const MeshReport report = check_mesh(F, V, {}, {});
    for (const int t : report.flat_triangles) result.is_flat[static_cast<std::size_t>(t)] = 1;
    for (Eigen::Index h = 0; h < F.size(); ++h) {
        const int a = F.data()[h];
        const int b = F(h / 3, (h + 1) % 3);
        const auto i = static_cast<std::size_t>(h);
        result.length[i] = (V.row(a) - V.row(b)).norm();
        result.is_point[i] = result.length[i] > 0 ? 0 : 1;
    }
    return result;
}

MeshReport check_repaired(const Triangles& F, int vertex_count) {
    const MeshRepair repair = repair_mesh(F, vertex_count, none(F));
    const int count = vertex_count + static_cast<int>(repair.copied_vertices.size());
    return check_mesh(repair.F, spread_vertices(count), {}, {});
}

TEST(CheckMesh, AcceptsSoundSurfacesAndCountsThem) {
    const TriangleMesh mesh = torus(8, 6);
    const MeshReport report = check_mesh(mesh.F, mesh.V, {10}, {});
    EXPECT_TRUE(report.is_accepted());
    EXPECT_TRUE(describe_refusals(report).empty());
    EXPECT_TRUE(describe_remarks(report).empty());
    EXPECT_EQ(report.genus, 1);
    EXPECT_EQ(report.counts.components, 1);
    const TriangleMesh open = cylinder(8, 3);
    EXPECT_EQ(check_mesh(open.F, open.V, {}, {}).counts.boundary_loops, 2);
    EXPECT_EQ(check_mesh(open.F, open.V, {}, {}).genus, 0);
}

TEST(CheckMesh, NamesEveryDefect) {
    EXPECT_EQ(check({{0, 1, 9}}, 3).wild_triangles, std::vector<int>{0});
    EXPECT_EQ(check({{0, 1, 2}, {2, 1, 1}}, 3).collapsed_triangles, std::vector<int>{1});
    EXPECT_EQ(check({{0, 1, 2}, {2, 1, 3}, {1, 0, 2}}, 4).duplicate_triangles,
              (std::vector<std::array<int, 2>>{{0, 2}}));
    const MeshReport fin = check({{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}, 5);
    ASSERT_EQ(fin.non_manifold_edges.size(), 1U);
    EXPECT_EQ(fin.non_manifold_edges[0].triangles, (std::vector<int>{0, 1, 2}));
    EXPECT_TRUE(fin.non_manifold_vertices.empty()) << "the edge says it already";
    const MeshReport turned = check({{0, 1, 2}, {0, 1, 3}}, 4);
    ASSERT_EQ(turned.misoriented_edges.size(), 1U);
    EXPECT_EQ(turned.misoriented_edges[0].a, 0);
    EXPECT_EQ(turned.misoriented_edges[0].b, 1);
    EXPECT_TRUE(turned.unorientable_parts.empty());
    EXPECT_EQ(check({{0, 1, 2}, {0, 3, 4}}, 5).non_manifold_vertices, std::vector<int>{0});
    EXPECT_EQ(check({{0, 1, 2}}, 5).isolated_vertices, (std::vector<int>{3, 4}));
    for (const MeshReport& report : {fin, turned}) {
        EXPECT_FALSE(report.is_accepted());
        EXPECT_EQ(describe_refusals(report).size(), 1U);
    }
    EXPECT_FALSE(check({}, 3).is_accepted());
}

TEST(CheckMesh, SeesThatAMoebiusStripHasOneSide) {
    // Five triangles around, the last one glued with a half turn.
    const MeshReport report = check({{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 0, 4}, {4, 0, 1}}, 5);
    EXPECT_EQ(report.unorientable_parts, std::vector<int>{0});
    EXPECT_FALSE(report.is_accepted());
}

TEST(CheckMesh, FindsWhatOnlySpaceTells) {
    Positions V(6, 3);
    V << 0, 0, 0, 2, 0, 0, 0, 2, 0,            // a triangle in a plane
        0.5, 0.5, -1, 0.5, 0.5, 1, 3, 3, 0.5;  // and one that a side of passes through it
    const Triangles F = triangles({{0, 1, 2}, {3, 4, 5}});
    EXPECT_EQ(check_mesh(F, V, {10}, {}).crossing_triangles,
              (std::vector<std::array<int, 2>>{{0, 1}}));
    EXPECT_TRUE(check_mesh(F, V, {}, {}).crossing_triangles.empty()) << "not asked for";
    V.row(3) = V.row(4);
    const MeshReport report = check_mesh(F, V, {}, {});
    EXPECT_EQ(report.coincident_vertices, (std::vector<std::array<int, 2>>{{3, 4}}));
    EXPECT_EQ(report.flat_triangles, std::vector<int>{1});
    // Scale and place do not matter.
    for (const double scale : {1e-12, 1e12}) {
        const Positions moved = (scale * V).rowwise() + scale * Eigen::RowVector3d(100, -50, 3);
        EXPECT_EQ(check_mesh(F, moved, {}, {}).flat_triangles, std::vector<int>{1}) << scale;
    }
}

TEST(CheckMesh, CrossingsAgreeWithTestingAllPairs) {
    TriangleMesh mesh = sphere(2);
    // A second sphere that cuts through the first.
    const auto n = static_cast<int>(mesh.V.rows());
    const auto m = mesh.F.rows();
    Positions V(2 * n, 3);
    V << mesh.V, mesh.V.rowwise() + Eigen::RowVector3d(0.7, 0.31, 0.11);
    Triangles F(2 * m, 3);
    F << mesh.F, (mesh.F.array() + n).matrix();
    const auto pairs = check_mesh(F, V, {100000}, {}).crossing_triangles;
    EXPECT_GT(pairs.size(), 20U);
    for (const auto& [s, t] : pairs) {
        EXPECT_LT(s, m) << "a sphere crosses itself";
        EXPECT_GE(t, m);
    }
    const MeshReport limited = check_mesh(F, V, {5}, {});
    EXPECT_EQ(limited.crossing_triangles.size(), 5U);
    EXPECT_TRUE(limited.has_more_crossings);
}

TEST(RepairMesh, LeavesASoundMeshAlone) {
    const TriangleMesh mesh = cylinder(7, 3);
    const MeshRepair repair =
        repair_mesh(mesh.F, static_cast<int>(mesh.V.rows()), degeneracies_of(mesh.F, mesh.V));
    EXPECT_EQ(repair.F, mesh.F);
    EXPECT_TRUE(repair.actions.empty());
    EXPECT_TRUE(repair.copied_vertices.empty());
}

TEST(RepairMesh, NamesVerticesWithoutTriangles) {
    const Triangles F = triangles({{0, 3, 4}});
    const MeshRepair repair = repair_mesh(F, 6, none(F));
    EXPECT_EQ(repair.F, F);
    ASSERT_EQ(repair.actions.size(), 1U);
    EXPECT_NE(repair.actions[0].find("1, 2, 5"), std::string::npos) << repair.actions[0];
}

TEST(RepairMesh, MendsConnectivity) {
    EXPECT_TRUE(check_repaired(triangles({{0, 1, 2}, {2, 1, 1}}), 3).is_accepted());
    EXPECT_TRUE(check_repaired(triangles({{0, 1, 2}, {2, 1, 3}, {1, 0, 2}}), 4).is_accepted());
    EXPECT_TRUE(check_repaired(triangles({{0, 1, 2}, {0, 1, 3}}), 4).is_accepted());
    const Triangles bow_tie = triangles({{0, 1, 2}, {0, 3, 4}});
    EXPECT_TRUE(check_repaired(bow_tie, 5).is_accepted());
    const MeshRepair repair = repair_mesh(bow_tie, 5, none(bow_tie));
    EXPECT_EQ(repair.copied_vertices, std::vector<int>{0});
    EXPECT_EQ(repair.F, triangles({{0, 1, 2}, {5, 3, 4}}));
    // A fin cannot be mended without a change of the surface.
    EXPECT_FALSE(check_repaired(triangles({{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}), 5).is_accepted());
}

TEST(RepairMesh, OrientsAsMostTrianglesAre) {
    TriangleMesh mesh = sphere(1);
    const Triangles sound = mesh.F;
    for (const int t : {3, 10, 30}) std::swap(mesh.F(t, 0), mesh.F(t, 1));
    const MeshRepair repair = repair_mesh(mesh.F, static_cast<int>(mesh.V.rows()), none(mesh.F));
    ASSERT_EQ(repair.actions.size(), 1U);
    EXPECT_NE(repair.actions[0].find("3, 10, 30"), std::string::npos) << repair.actions[0];
    const Topology topology = build_topology(repair.F, static_cast<int>(mesh.V.rows()));
    EXPECT_EQ(repair.F.row(0), sound.row(0));
    EXPECT_EQ(count_surface(topology).euler_characteristic, 2);
}

TEST(RepairMesh, ContractsEdgesWithoutLengthAndFlipsCaps) {
    // Vertex 4 lies on the side 0-1 of the triangle (0, 1, 4); 5 coincides with 2.
    Positions V(6, 3);
    V << 0, 0, 0, 2, 0, 0, 1, 2, 0, 1, -2, 0, 1, 0, 0, 1, 2, 0;
    const Triangles F = triangles({{0, 4, 2}, {4, 5, 2}, {4, 1, 5}, {0, 1, 4}, {1, 0, 3}});
    ASSERT_EQ(check_mesh(F, V, {}, {}).flat_triangles.size(), 2U);
    const MeshRepair repair = repair_mesh(F, 6, degeneracies_of(F, V));
    const MeshReport report = check_mesh(repair.F, V, {}, {});
    EXPECT_TRUE(report.is_accepted());
    EXPECT_TRUE(report.flat_triangles.empty());
    EXPECT_EQ(report.counts.euler_characteristic, 1);
    double area = 0;
    for (Eigen::Index t = 0; t < repair.F.rows(); ++t) {
        const Vector3 a = V.row(repair.F(t, 0)).transpose();
        const Vector3 u = V.row(repair.F(t, 1)).transpose() - a;
        const Vector3 v = V.row(repair.F(t, 2)).transpose() - a;
        area += u.cross(v).z() / 2;
    }
    EXPECT_DOUBLE_EQ(area, 4) << "the surface has changed";
}

}  // namespace
}  // namespace kinequad::test
