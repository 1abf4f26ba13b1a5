#include <gtest/gtest.h>

#include <cstring>
#include <numeric>

#include "kinequad/core/error.h"
#include "quad_checks.h"
#include "support/shapes.h"

namespace kinequad::test {
namespace {

using Valences = std::map<int, int>;

MappedShape mapped_torus(int around, int along, int across, int up) {
    return map_patches(torus(around, along), 1, along, around, across, up);
}
MappedShape mapped_square(int n, int across, int up) {
    return map_patches(square(n), 1, n, n, across, up);
}
MappedShape mapped_cube(int n, int k) { return map_patches(cube(n), 6, n, n, k, k); }
MappedShape mapped_cylinder(int around, int along, int across, int up) {
    return map_patches(cylinder(around, along), 1, along, around, across, up);
}

const std::vector<std::array<int, 3>> ell = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
const std::vector<std::array<int, 3>> ring = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0},
                                              {2, 1, 0}, {0, 2, 0}, {1, 2, 0}, {2, 2, 0}};
/// Three arms on a corner: they meet in a vertex of six quarter turns.
const std::vector<std::array<int, 3>> jack = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/// One of each kind, with integer lines in general position and along edges.
std::vector<MappedShape> all_shapes() {
    return {mapped_torus(12, 8, 7, 5),   mapped_torus(5, 4, 10, 8), mapped_square(4, 7, 3),
            mapped_square(5, 5, 5),      mapped_cube(3, 4),         mapped_cube(2, 6),
            mapped_cylinder(9, 4, 6, 5), map_polycube(ell, 3, 2),   map_polycube(ring, 2, 3),
            map_polycube(jack, 3, 5)};
}

TEST(ExtractQuads, TorusIsARegularGrid) {
    for (const auto& [across, up] : {std::array{7, 5}, {12, 8}, {24, 16}, {3, 4}, {30, 31}}) {
        const MappedShape shape = mapped_torus(12, 8, across, up);
        const QuadMesh mesh = extract_valid(shape.map);
        EXPECT_EQ(mesh.Q.rows(), across * up);
        EXPECT_EQ(mesh.vertex.size(), static_cast<std::size_t>(across * up));
        EXPECT_EQ(irregular_valences(mesh), Valences{});
    }
}

TEST(ExtractQuads, SplitsRowsWhereEdgesWouldJoinTheSameVertices) {
    // Two cells around: the rows along the torus are split, those around it are not.
    const QuadMesh torus = extract_valid(mapped_torus(12, 8, 2, 7).map);
    EXPECT_EQ(torus.vertex.size(), 21U) << "one of two rows is enough for three cells around";
    EXPECT_EQ(irregular_valences(torus), Valences{});
    extract_valid(mapped_torus(12, 8, 2, 2).map);
    // Boundary loops of two edges.
    const QuadMesh cylinder = extract_valid(mapped_cylinder(8, 4, 2, 5).map);
    EXPECT_EQ(irregular_valences(cylinder), Valences{});
}

TEST(ExtractQuads, SaysThatAQuadThatBordersOnItselfNeedsMore) {
    const GridMap map = mapped_torus(12, 8, 1, 7).map;
    try {
        require_valid(verify_quad_mesh(extract_quads(map, Context{}), map.topology));
        ADD_FAILURE() << "accepted";
    } catch (const VerificationError& error) {
        EXPECT_NE(std::string(error.what()).find("ask for more quads"), std::string::npos);
    }
}

TEST(ExtractQuads, SquareHasItsCornersAndBoundary) {
    for (const auto& [across, up] : {std::array{1, 1}, {2, 1}, {3, 7}, {4, 4}, {8, 12}, {17, 5}}) {
        const MappedShape shape = mapped_square(4, across, up);
        const QuadMesh mesh = extract_valid(shape.map);
        EXPECT_EQ(mesh.Q.rows(), across * up);
        EXPECT_EQ(mesh.vertex.size(), static_cast<std::size_t>((across + 1) * (up + 1)));
        EXPECT_EQ(irregular_valences(mesh), (Valences{{-2, 4}}));
        // The vertices are the lattice points of the unit square, each once.
        const Positions V = positions_of(mesh, shape.mesh);
        std::vector<bool> is_met(mesh.vertex.size(), false);
        for (Eigen::Index i = 0; i < V.rows(); ++i) {
            const double x = V(i, 0) * across;
            const double y = V(i, 1) * up;
            EXPECT_NEAR(x, std::round(x), 1e-7);
            EXPECT_NEAR(y, std::round(y), 1e-7);
            is_met[static_cast<std::size_t>(std::lround(y) * (across + 1) + std::lround(x))] = true;
        }
        EXPECT_EQ(std::count(is_met.begin(), is_met.end(), false), 0);
    }
}

TEST(ExtractQuads, QuadsAreCounterClockwiseUnitCells) {
    const MappedShape shape = mapped_square(5, 7, 4);
    const QuadMesh mesh = extract_valid(shape.map);
    const Positions V = positions_of(mesh, shape.mesh);
    for (Eigen::Index q = 0; q < mesh.Q.rows(); ++q) {
        const Vector3 first = V.row(mesh.Q(q, 1)) - V.row(mesh.Q(q, 0));
        const Vector3 last = V.row(mesh.Q(q, 3)) - V.row(mesh.Q(q, 0));
        EXPECT_NEAR(first.cross(last).z(), 1.0 / 28, 1e-7);
    }
}

TEST(ExtractQuads, SameGridGivesTheInputsVerticesBack) {
    const MappedShape shape = mapped_square(6, 6, 6);
    const QuadMesh mesh = extract_valid(shape.map);
    EXPECT_EQ(mesh.vertex.size(), static_cast<std::size_t>(shape.mesh.V.rows()));
    for (const SurfacePoint& point : mesh.vertex) EXPECT_EQ(point.barycentric.maxCoeff(), 1.0);
}

TEST(ExtractQuads, CubeHasEightCorners) {
    for (const int n : {1, 3, 4}) {
        for (const int k : {1, 2, 3, 4, 7, 12}) {
            const QuadMesh mesh = extract_valid(mapped_cube(n, k).map);
            EXPECT_EQ(mesh.Q.rows(), 6 * k * k);
            EXPECT_EQ(irregular_valences(mesh), (Valences{{3, 8}}));
        }
    }
}

TEST(ExtractQuads, CylinderHasTwoBoundaryLoops) {
    const QuadMesh mesh = extract_valid(mapped_cylinder(9, 4, 7, 5).map);
    EXPECT_EQ(mesh.Q.rows(), 35);
    EXPECT_EQ(mesh.vertex.size(), 42U);
    EXPECT_EQ(irregular_valences(mesh), Valences{});
}

TEST(ExtractQuads, NegativeSingularitiesAndGenus) {
    // The finest grid that the solids have by themselves tells the valences.
    EXPECT_EQ(irregular_valences(extract_valid(map_polycube(ell, 3, 4).map)),
              (Valences{{3, 10}, {5, 2}}));
    EXPECT_EQ(irregular_valences(extract_valid(map_polycube(ring, 3, 2).map)),
              (Valences{{3, 8}, {5, 8}}));
    const QuadMesh mesh = extract_valid(map_polycube(jack, 2, 3).map);
    EXPECT_EQ(irregular_valences(mesh), (Valences{{3, 13}, {5, 3}, {6, 1}}));
    EXPECT_EQ(mesh.Q.rows(), 18 * 9);
}

TEST(ExtractQuads, HoleWithReflexCornersAndIsolatedVertices) {
    const MappedShape full = mapped_square(6, 12, 12);
    const CornerCoordinates uv = patch_coordinates(1, 6, 6, 12, 12);
    std::vector<int> kept;
    for (int t = 0; t < full.mesh.F.rows(); ++t) {
        const int row = t / 12;
        const int column = t / 2 % 6;
        if (row < 2 || row > 4 || column < 1 || column > 3) kept.push_back(t);
    }
    Triangles F(static_cast<Eigen::Index>(kept.size()), 3);
    CornerCoordinates kept_uv(F.size(), 2);
    for (Eigen::Index t = 0; t < F.rows(); ++t) {
        const int from = kept[static_cast<std::size_t>(t)];
        F.row(t) = full.mesh.F.row(from);
        kept_uv.middleRows<3>(3 * t) = uv.middleRows<3>(3 * from);
    }
    const GridMap map = make_grid_map(F, static_cast<int>(full.mesh.V.rows()), kept_uv);
    const QuadMesh mesh = extract_valid(map);
    EXPECT_EQ(mesh.Q.rows(), 144 - 36);
    EXPECT_EQ(irregular_valences(mesh), (Valences{{-2, 4}, {-4, 4}}));
}

TEST(ExtractQuads, DoesNotDependOnTheCharts) {
    std::mt19937 random(5);
    for (const MappedShape& shape : all_shapes()) {
        const QuadMesh expected = extract_valid(shape.map);
        const int triangles = shape.map.topology.triangle_count;
        for (const int cells : {3, 1 << 20}) {
            const GridMap map = change_charts(shape.map, random_charts(triangles, cells, random));
            const QuadMesh mesh = extract_valid(map);
            expect_same_quads(mesh.Q, positions_of(mesh, shape.mesh), expected.Q,
                              positions_of(expected, shape.mesh));
        }
    }
}

TEST(ExtractQuads, DoesNotDependOnTheOrderOfTrianglesAndCorners) {
    std::mt19937 random(6);
    const CornerCoordinates uv = patch_coordinates(6, 3, 3, 4, 4);
    const MappedShape shape = mapped_cube(3, 4);
    const QuadMesh expected = extract_valid(shape.map);
    std::vector<int> order(static_cast<std::size_t>(shape.mesh.F.rows()));
    std::iota(order.begin(), order.end(), 0);
    for (int round = 0; round < 10; ++round) {
        std::shuffle(order.begin(), order.end(), random);
        TriangleMesh mesh = shape.mesh;
        CornerCoordinates renumbered = uv;
        for (int t = 0; t < mesh.F.rows(); ++t) {
            for (int k = 0; k < 3; ++k) {
                const int from = order[static_cast<std::size_t>(t)];
                const int corner = (k + t + round) % 3;
                mesh.F(t, k) = shape.mesh.F(from, corner);
                renumbered.row(3 * t + k) = uv.row(3 * from + corner);
            }
        }
        const GridMap map = make_grid_map(mesh.F, static_cast<int>(mesh.V.rows()), renumbered);
        const QuadMesh result = extract_valid(map);
        expect_same_quads(result.Q, positions_of(result, mesh), expected.Q,
                          positions_of(expected, shape.mesh));
    }
}

TEST(ExtractQuads, KeepsConnectivityWhenVerticesMove) {
    std::mt19937 random(7);
    for (const MappedShape& shape : all_shapes()) {
        const QuadMesh expected = extract_valid(shape.map);
        for (const int lattice : {0, 1, 2, 4}) {
            GridMap map = shape.map;
            for (int round = 0; round < 4; ++round) {
                map = jitter_vertices(std::move(map), 0.8, lattice, random);
                const QuadMesh mesh = extract_valid(map);
                EXPECT_EQ(mesh.Q.rows(), expected.Q.rows());
                EXPECT_EQ(mesh.vertex.size(), expected.vertex.size());
                EXPECT_EQ(irregular_valences(mesh), irregular_valences(expected));
            }
        }
    }
}

TEST(ExtractQuads, VerticesLieAtIntegerPointsOfTheMap) {
    std::mt19937 random(8);
    for (const MappedShape& shape : all_shapes()) {
        const GridMap map = jitter_vertices(shape.map, 0.4, 0, random);
        for (const SurfacePoint& point : extract_valid(map).vertex) {
            Vector2 uv = Vector2::Zero();
            for (int k = 0; k < 3; ++k) {
                const auto z = map.corner[static_cast<std::size_t>(3 * point.triangle + k)];
                uv +=
                    point.barycentric[k] * Vector2(double(z.u), double(z.v)) / double(GridMap::one);
            }
            EXPECT_NEAR(uv[0], std::round(uv[0]), 1e-9);
            EXPECT_NEAR(uv[1], std::round(uv[1]), 1e-9);
        }
    }
}

TEST(ExtractQuads, ManyWindingsOfOneTriangle) {
    // A torus of 1 x 1 square whose triangulation is sheared: each quad edge crosses edges many
    // times.
    const int n = 3;
    const int shear = 50;
    const TriangleMesh mesh = torus(n, n);
    CornerCoordinates uv = patch_coordinates(1, n, n, 4, 5);
    uv.col(0) += shear * 4.0 * uv.col(1);
    const QuadMesh quads = extract_valid(make_grid_map(mesh.F, n * n, uv));
    EXPECT_EQ(quads.Q.rows(), 20);
    EXPECT_EQ(irregular_valences(quads), Valences{});
}

TEST(ExtractQuads, RefinementIsExpressedInTheInput) {
    // The map's mesh is the square of 2 x 2, all of whose triangles are said to lie in one big
    // triangle.
    MappedShape shape = mapped_square(2, 3, 3);
    TriangleMesh input;
    input.V.resize(3, 3);
    input.V << 0, 0, 0, 2, 0, 0, 0, 2, 0;
    input.F.resize(1, 3);
    input.F << 0, 1, 2;
    for (int h = 0; h < shape.mesh.F.size(); ++h) {
        const auto p = shape.mesh.V.row(shape.mesh.F.data()[h]);
        shape.map.mesh.parent[static_cast<std::size_t>(h / 3)] = 0;
        shape.map.mesh.barycentric.row(h) << 1 - (p[0] + p[1]) / 2, p[0] / 2, p[1] / 2;
    }
    const QuadMesh mesh = extract_quads(shape.map, Context{});
    const Positions V = positions_of(mesh, input);
    for (Eigen::Index i = 0; i < V.rows(); ++i) {
        EXPECT_NEAR(V(i, 0) * 3, std::round(V(i, 0) * 3), 1e-7);
        EXPECT_NEAR(V(i, 1) * 3, std::round(V(i, 1) * 3), 1e-7);
    }
    EXPECT_EQ(mesh.Q.rows(), 9);
}

TEST(ExtractQuads, SameBytesOnAnyNumberOfThreads) {
    const GridMap map = mapped_cube(6, 9).map;
    Context context;
    context.threads = 1;
    const QuadMesh expected = extract_quads(map, context);
    for (const int threads : {2, 8}) {
        context.threads = threads;
        const QuadMesh mesh = extract_quads(map, context);
        ASSERT_EQ(mesh.vertex.size(), expected.vertex.size());
        EXPECT_EQ(mesh.Q, expected.Q);
        for (std::size_t i = 0; i < mesh.vertex.size(); ++i) {
            EXPECT_EQ(mesh.vertex[i].triangle, expected.vertex[i].triangle);
            EXPECT_EQ(std::memcmp(mesh.vertex[i].barycentric.data(),
                                  expected.vertex[i].barycentric.data(), sizeof(Vector3)),
                      0);
        }
    }
}

}  // namespace
}  // namespace kinequad::test
