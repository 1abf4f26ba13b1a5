#include "kinequad/measure/mesh_counts.h"

#include <gtest/gtest.h>

#include <vector>

#include "kinequad/core/error.h"
#include "kinequad/mesh/topology.h"
#include "quad_grid.h"
#include "support/shapes.h"

namespace kinequad {
namespace {

Polygons faces_of(const std::vector<std::vector<int>>& faces) {
    Polygons result;
    for (const auto& face : faces) result.add(face);
    return result;
}

TEST(MeshCounts, CountsACube) {
    const MeshCounts c = count_mesh(make_polygons(test::quad_cube().Q), 8);
    EXPECT_EQ(c.vertices, 8);
    EXPECT_EQ(c.edges, 12);
    EXPECT_EQ(c.faces, 6);
    EXPECT_EQ(c.quads, 6);
    EXPECT_EQ(c.quad_percent(), 100);
    EXPECT_EQ(c.irregular_vertices, 8);
    EXPECT_EQ(c.irregular_percent(), 100);
    EXPECT_EQ(c.euler_characteristic, 2);
    EXPECT_EQ(c.components, 1);
    EXPECT_EQ(c.boundary_edges, 0);
    EXPECT_EQ(c.misoriented_edges, 0);
    EXPECT_TRUE(c.is_manifold());
}

TEST(MeshCounts, CountsAGridWithoutIsolatedVertices) {
    const MeshCounts c = count_mesh(make_polygons(test::quad_grid(4).Q), 30);
    EXPECT_EQ(c.vertices, 25);
    EXPECT_EQ(c.irregular_vertices, 4) << "the corners have two edges";
    EXPECT_EQ(c.boundary_edges, 16);
    EXPECT_EQ(c.boundary_loops, 1);
    EXPECT_EQ(c.euler_characteristic, 1);
}

TEST(MeshCounts, AgreesWithTheTopologyOfTriangleMeshes) {
    for (const TriangleMesh& mesh : {test::torus(12, 8), test::cylinder(9, 4), test::sphere(2)}) {
        const int n = static_cast<int>(mesh.V.rows());
        const SurfaceCounts expected = count_surface(build_topology(mesh.F, n));
        const MeshCounts c = count_mesh(make_polygons(mesh.F), n);
        EXPECT_EQ(c.triangles, expected.triangles);
        EXPECT_EQ(c.edges, expected.edges);
        EXPECT_EQ(c.vertices, expected.vertices);
        EXPECT_EQ(c.components, expected.components);
        EXPECT_EQ(c.boundary_loops, expected.boundary_loops);
        EXPECT_EQ(c.euler_characteristic, expected.euler_characteristic);
        EXPECT_TRUE(c.is_manifold());
    }
}

TEST(MeshCounts, FindsDefects) {
    const MeshCounts fin = count_mesh(faces_of({{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}), 5);
    EXPECT_EQ(fin.non_manifold_edges, 1);
    const MeshCounts bow_tie = count_mesh(faces_of({{0, 1, 2}, {0, 3, 4}}), 5);
    EXPECT_EQ(bow_tie.non_manifold_vertices, 1);
    EXPECT_EQ(bow_tie.non_manifold_edges, 0);
    EXPECT_EQ(bow_tie.components, 1);
    const MeshCounts turned = count_mesh(faces_of({{0, 1, 2}, {0, 1, 3}}), 4);
    EXPECT_EQ(turned.misoriented_edges, 1);
    const MeshCounts twice =
        count_mesh(faces_of({{0, 1, 2}, {2, 0, 1}, {2, 1, 0}, {3, 4, 5, 6, 7}}), 8);
    EXPECT_EQ(twice.duplicate_faces, 2);
    EXPECT_EQ(twice.components, 2);
    EXPECT_EQ(twice.other_faces, 1);
}

TEST(MeshCounts, RefusesFacesThatAreNone) {
    EXPECT_THROW(count_mesh(faces_of({}), 3), InputError);
    EXPECT_THROW(count_mesh(faces_of({{0, 1}}), 3), InputError);
    EXPECT_THROW(count_mesh(faces_of({{0, 1, 3}}), 3), InputError);
    EXPECT_THROW(count_mesh(faces_of({{0, -1, 2}}), 3), InputError);
}

}  // namespace
}  // namespace kinequad
