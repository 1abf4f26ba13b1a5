#include "kinequad/gridmap/compute_grid_map.h"

#include <gtest/gtest.h>

#include <atomic>

#include "gridmap/prepared_map.h"
#include "kinequad/core/error.h"
#include "kinequad/extract/extract_quads.h"
#include "kinequad/extract/verify_quad_mesh.h"

namespace kinequad {
namespace {

GridMap map_of(const test::Surface& surface, int vertices, const Context& context = {}) {
    const CrossField field = test::field_of(surface);
    return compute_grid_map(surface.topology, surface.metric, field, {.vertex_count = vertices},
                            context);
}

/// Extracts and verifies; returns the quad mesh.
QuadMesh expect_valid(const test::Surface& surface, const GridMap& map) {
    EXPECT_TRUE(verify_grid_map(map).valid());
    const QuadMesh quads = extract_quads(map, Context{});
    const QuadMeshReport report = verify_quad_mesh(quads, surface.topology);
    EXPECT_TRUE(report.valid());
    return quads;
}

TEST(ComputeGridMap, CoversEverySurfaceWithTheWantedNumberOfVertices) {
    for (const test::Surface& surface : test::map_surfaces()) {
        for (const int vertices : {700, 2500}) {
            SCOPED_TRACE(surface.name + " " + std::to_string(vertices));
            const QuadMesh quads = expect_valid(surface, map_of(surface, vertices));
            EXPECT_NEAR(static_cast<double>(quads.vertex.size()), vertices, 0.05 * vertices);
        }
    }
}

TEST(ComputeGridMap, RefinementStaysWithinTheInput) {
    const test::Surface surface = test::surface_of(test::sphere(3));
    const GridMap map = map_of(surface, 300);
    ASSERT_EQ(map.mesh.F.rows(), static_cast<Eigen::Index>(map.mesh.parent.size()));
    Eigen::VectorXd covered = Eigen::VectorXd::Zero(surface.topology.triangle_count);
    for (Eigen::Index t = 0; t < map.mesh.F.rows(); ++t) {
        const Eigen::Matrix3d b = map.mesh.barycentric.middleRows<3>(3 * t);
        EXPECT_GE(b.minCoeff(), 0);
        EXPECT_LT((b.rowwise().sum().array() - 1).abs().maxCoeff(), 1e-12);
        covered[map.mesh.parent[static_cast<std::size_t>(t)]] += b.determinant();
        for (int k = 0; k < 3; ++k) {
            const int v = map.mesh.F(t, k);
            if (v >= surface.topology.vertex_count) continue;
            // An input vertex is a corner of the parent, exactly.
            const int parent = map.mesh.parent[static_cast<std::size_t>(t)];
            int corner = 0;
            while (corner < 2 && b(k, corner) != 1) ++corner;
            EXPECT_EQ(b(k, corner), 1);
            EXPECT_EQ(surface.topology.origin[at(3 * parent + corner)], v);
        }
    }
    EXPECT_LT((covered.array() - 1).abs().maxCoeff(), 1e-9);
}

TEST(ComputeGridMap, DoesNotDependOnTheUnitOfLength) {
    for (const TriangleMesh& shape : {test::sphere(3), test::cylinder(20, 9)}) {
        for (const double scale : {1e-9, 1e-3, 1e3, 1e9}) {
            SCOPED_TRACE(scale);
            TriangleMesh scaled = shape;
            scaled.V *= scale;
            const test::Surface surface = test::surface_of(scaled);
            const QuadMesh quads = expect_valid(surface, map_of(surface, 600));
            EXPECT_NEAR(static_cast<double>(quads.vertex.size()), 600, 30);
        }
    }
}

TEST(ComputeGridMap, RenumberingIsNoObstacle) {
    std::mt19937 random(2);
    for (int run = 0; run < 4; ++run) {
        TriangleMesh mesh = test::torus(24, 12);
        std::vector<int> name(at(static_cast<int>(mesh.V.rows())));
        std::iota(name.begin(), name.end(), 0);
        std::shuffle(name.begin(), name.end(), random);
        const Positions before = mesh.V;
        for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
            mesh.V.row(name[static_cast<std::size_t>(v)]) = before.row(v);
        }
        for (int& v : mesh.F.reshaped()) v = name[at(v)];
        std::vector<int> order(at(static_cast<int>(mesh.F.rows())));
        std::iota(order.begin(), order.end(), 0);
        std::shuffle(order.begin(), order.end(), random);
        const Triangles triangles = mesh.F;
        for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
            const int k = static_cast<int>(random() % 3);
            for (int i = 0; i < 3; ++i) {
                mesh.F(t, i) = triangles(order[static_cast<std::size_t>(t)], (i + k) % 3);
            }
        }
        const test::Surface surface = test::surface_of(mesh);
        const QuadMesh quads = expect_valid(surface, map_of(surface, 600));
        EXPECT_NEAR(static_cast<double>(quads.vertex.size()), 600, 30);
    }
}

TEST(ComputeGridMap, TheSameInputGivesTheSameMap) {
    const test::Surface surface = test::surface_of(test::sphere(3));
    Context one;
    one.threads = 1;
    Context eight;
    eight.threads = 8;
    const GridMap a = map_of(surface, 500, one);
    const GridMap b = map_of(surface, 500, eight);
    EXPECT_EQ(a.corner, b.corner);
    EXPECT_EQ(a.transition, b.transition);
    EXPECT_EQ(a.mesh.F, b.mesh.F);
}

TEST(ComputeGridMap, EdgeLengthTakesPrecedence) {
    const test::Surface surface = test::surface_of(test::sphere(3));
    const double area = triangle_areas(surface.topology, surface.metric).sum();
    const double h = std::sqrt(area / 900);
    const GridMap map = compute_grid_map(surface.topology, surface.metric, test::field_of(surface),
                                         {.vertex_count = 50, .edge_length = h}, Context{});
    EXPECT_NEAR(static_cast<double>(extract_quads(map, Context{}).Q.rows()), 900, 45);
}

TEST(ComputeGridMap, IsValidOrSaysWhyNotAtAnyDensity) {
    // Far fewer vertices than the cones need room for, and more than the mesh has.
    for (const test::Surface& surface : test::map_surfaces()) {
        for (const int vertices : {1, 4, 12, 30, 100}) {
            SCOPED_TRACE(surface.name + " " + std::to_string(vertices));
            try {
                EXPECT_TRUE(verify_grid_map(map_of(surface, vertices)).valid());
            } catch (const GridMapError& error) {
                EXPECT_NE(std::string(error.what()).find("more vertices"), std::string::npos)
                    << error.what();
            }
        }
    }
}

TEST(ComputeGridMap, SmallPartsGetAsManyQuadsAsTheyNeed) {
    // A sphere and a hundred times smaller ones beside it, which are far smaller than one quad.
    const TriangleMesh ball = test::sphere(3);
    const auto n = static_cast<int>(ball.V.rows());
    const auto m = ball.F.rows();
    constexpr int small = 5;
    TriangleMesh mesh;
    mesh.V.resize((small + 1) * n, 3);
    mesh.F.resize((small + 1) * m, 3);
    for (int i = 0; i <= small; ++i) {
        const double scale = i < small ? 0.01 : 1;
        mesh.V.middleRows(i * n, n) = (scale * ball.V).rowwise() + Eigen::RowVector3d(3 * i, 0, 0);
        mesh.F.middleRows(i * m, m) = (ball.F.array() + i * n).matrix();
    }
    const test::Surface surface = test::surface_of(mesh);
    const GridMap map = map_of(surface, 500);
    const QuadMesh quads = expect_valid(surface, map);
    EXPECT_NEAR(static_cast<double>(quads.vertex.size()), 500, 50);
    EXPECT_EQ(count_surface(surface.topology).components, small + 1);
    EXPECT_NEAR(map.quads, static_cast<double>(quads.Q.rows()), 1e-6);
}

TEST(ComputeGridMap, StopsWhenAsked) {
    const std::atomic<bool> stop = true;
    Context context;
    context.cancel = &stop;
    const test::Surface surface = test::surface_of(test::sphere(3));
    const CrossField field = test::field_of(surface);
    EXPECT_THROW(compute_grid_map(surface.topology, surface.metric, field, {}, context), Cancelled);
}

TEST(ComputeGridMap, RefusesAFieldWhoseIndicesAreWrong) {
    const test::Surface surface = test::surface_of(test::cube(4));
    CrossField field = test::field_of(surface);
    int v = 0;
    while (field.index[v] == 0) ++v;
    field.index[v] = 0;
    EXPECT_THROW(compute_grid_map(surface.topology, surface.metric, field, {}, Context{}),
                 GridMapError);
}

TEST(ComputeGridMap, GivesUpLinesThatCrossesDoNotFollow) {
    const test::Surface surface = test::surface_of(test::sphere(3));
    GridMapOptions options;
    options.vertex_count = 300;
    // Around a triangle a line turns by 120 degrees at every corner, and crosses by 90.
    options.line_edges = {surface.topology.edge[0], surface.topology.edge[1],
                          surface.topology.edge[2]};
    const GridMap map = compute_grid_map(surface.topology, surface.metric, test::field_of(surface),
                                         options, Context{});
    expect_valid(surface, map);
}

TEST(EdgeLengthFor, SolvesTheCountOfASquareGrid) {
    const test::Surface square = test::surface_of(test::square(3));
    for (const int k : {1, 5, 40}) {
        EXPECT_NEAR(edge_length_for(square.topology, square.metric, (k + 1) * (k + 1)), 1.0 / k,
                    1e-9);
    }
    // A cube of edge length 2 with n x n quads a side has 6 n^2 + 2 vertices.
    const test::Surface cube = test::surface_of(test::cube(3));
    EXPECT_NEAR(edge_length_for(cube.topology, cube.metric, 6 * 49 + 2), 2.0 / 7, 1e-9);
    EXPECT_GT(edge_length_for(cube.topology, cube.metric, 0), 0);
}

}  // namespace
}  // namespace kinequad
