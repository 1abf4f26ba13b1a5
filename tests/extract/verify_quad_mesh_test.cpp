#include "kinequad/extract/verify_quad_mesh.h"

#include <gtest/gtest.h>

#include <limits>

#include "kinequad/core/error.h"
#include "quad_checks.h"
#include "support/shapes.h"

namespace kinequad::test {
namespace {

struct Case {
    QuadMesh mesh;
    Topology input;
};

Case cube_case() {
    const MappedShape shape = map_patches(cube(2), 6, 2, 2, 3, 3);
    return {extract_quads(shape.map, Context{}), shape.map.topology};
}

Case square_case() {
    const MappedShape shape = map_patches(square(2), 1, 2, 2, 4, 4);
    return {extract_quads(shape.map, Context{}), shape.map.topology};
}

void remove_quads(QuadMesh& mesh, const std::vector<int>& removed) {
    Quads kept(mesh.Q.rows() - static_cast<Eigen::Index>(removed.size()), 4);
    Eigen::Index row = 0;
    for (int q = 0; q < mesh.Q.rows(); ++q) {
        if (std::find(removed.begin(), removed.end(), q) == removed.end())
            kept.row(row++) = mesh.Q.row(q);
    }
    mesh.Q = kept;
}

TEST(VerifyQuadMesh, CountsAValidMesh) {
    const auto [mesh, input] = cube_case();
    const QuadMeshReport report = verify_quad_mesh(mesh, input);
    EXPECT_TRUE(report.valid());
    EXPECT_EQ(report.vertices, 56);
    EXPECT_EQ(report.edges, 108);
    EXPECT_EQ(report.quads, 54);
    EXPECT_EQ(report.components, 1);
    EXPECT_EQ(report.boundary_loops, 0);
    EXPECT_EQ(report.euler_characteristic, 2);
}

TEST(VerifyQuadMesh, AHoleChangesTheTopology) {
    auto [mesh, input] = cube_case();
    remove_quads(mesh, {0});
    const QuadMeshReport report = verify_quad_mesh(mesh, input);
    EXPECT_EQ(report.boundary_loops, 1);
    EXPECT_EQ(report.euler_characteristic, 1);
    EXPECT_FALSE(report.valid());
    EXPECT_THROW(require_valid(report), VerificationError);
}

TEST(VerifyQuadMesh, ATurnedQuadIsMisoriented) {
    auto [mesh, input] = cube_case();
    mesh.Q.row(5).reverseInPlace();
    EXPECT_EQ(verify_quad_mesh(mesh, input).misoriented_edges, 4);
    EXPECT_FALSE(verify_quad_mesh(mesh, input).valid());
}

TEST(VerifyQuadMesh, ARepeatedQuadIsNonManifold) {
    auto [mesh, input] = cube_case();
    mesh.Q.conservativeResize(mesh.Q.rows() + 1, 4);
    mesh.Q.bottomRows<1>() = mesh.Q.topRows<1>();
    EXPECT_EQ(verify_quad_mesh(mesh, input).non_manifold_edges, 4);
}

TEST(VerifyQuadMesh, TwoFansAtAVertex) {
    auto [mesh, input] = square_case();
    // Opposite quads around a vertex of the inside.
    const auto topology = build_quad_topology(mesh.Q, static_cast<int>(mesh.vertex.size()));
    int inside = 0;
    while (topology.is_boundary_vertex(inside)) ++inside;
    const int h = topology.vertex_half_edge[static_cast<std::size_t>(inside)];
    const int opposite = topology.rotate_counter_clockwise(topology.rotate_counter_clockwise(h));
    remove_quads(mesh, {h / 4, opposite / 4});
    EXPECT_EQ(verify_quad_mesh(mesh, input).non_manifold_vertices, 1);
    EXPECT_FALSE(verify_quad_mesh(mesh, input).valid());
}

TEST(VerifyQuadMesh, BadIndicesAndIsolatedVertices) {
    auto [mesh, input] = cube_case();
    mesh.vertex.push_back(mesh.vertex.front());
    EXPECT_EQ(verify_quad_mesh(mesh, input).isolated_vertices, 1);
    mesh.Q(0, 1) = 1000000;
    mesh.Q(3, 1) = -1;
    mesh.Q(7, 1) = mesh.Q(7, 3);
    EXPECT_EQ(verify_quad_mesh(mesh, input).invalid_quads, 3);
    EXPECT_EQ(verify_quad_mesh(mesh, input).quads, 51);
}

TEST(VerifyQuadMesh, PointsOffTheSurface) {
    auto [mesh, input] = cube_case();
    mesh.vertex[0].triangle = input.triangle_count;
    mesh.vertex[1].triangle = -1;
    mesh.vertex[2].barycentric = Vector3(1.5, -0.5, 0);
    mesh.vertex[3].barycentric = Vector3(0.5, 0.4, 0);
    mesh.vertex[4].barycentric[0] = std::numeric_limits<double>::quiet_NaN();
    const QuadMeshReport report = verify_quad_mesh(mesh, input);
    EXPECT_EQ(report.invalid_points, 5);
    EXPECT_FALSE(report.valid());
}

TEST(VerifyQuadMesh, EmptyMeshOfASurface) {
    const auto [mesh, input] = cube_case();
    EXPECT_FALSE(verify_quad_mesh(QuadMesh{}, input).valid());
    EXPECT_THROW(require_valid(verify_quad_mesh(QuadMesh{}, input)), VerificationError);
}

TEST(VerifyQuadMesh, ComponentsAreCounted) {
    const auto [mesh, input] = cube_case();
    QuadMesh twice = mesh;
    const auto n = static_cast<int>(mesh.vertex.size());
    twice.vertex.insert(twice.vertex.end(), mesh.vertex.begin(), mesh.vertex.end());
    twice.Q.conservativeResize(2 * mesh.Q.rows(), 4);
    twice.Q.bottomRows(mesh.Q.rows()) = mesh.Q.array() + n;
    const QuadMeshReport report = verify_quad_mesh(twice, input);
    EXPECT_EQ(report.components, 2);
    EXPECT_EQ(report.euler_characteristic, 4);
    EXPECT_FALSE(report.valid());
}

}  // namespace
}  // namespace kinequad::test
