#include "kinequad/gridmap/grid_map.h"

#include <gtest/gtest.h>

#include "support/grid_maps.h"
#include "support/shapes.h"

namespace kinequad {
namespace {

constexpr GridMap::Coordinate half = {GridMap::one / 2, GridMap::one / 2};

GridMap cube_map() { return test::map_polycube({{0, 0, 0}}, 3, 3).map; }
GridMap rectangle_map() { return test::map_patches(test::square(4), 1, 4, 4, 3, 5).map; }

/// All charts moved by the same translation.
GridMap shifted(const GridMap& map, GridMap::Coordinate by) {
    return test::change_charts(
        map, std::vector<GridMap::Transition>(at(map.topology.triangle_count), {0, by}));
}

int regular_inner_vertex(const GridMap& map) {
    for (int v = 0; v < map.topology.vertex_count; ++v) {
        if (map.index[v] == 0 && !map.topology.is_boundary_vertex(v)) return v;
    }
    return -1;
}

int singular_vertex(const GridMap& map) {
    for (int v = 0; v < map.topology.vertex_count; ++v) {
        if (map.index[v] != 0) return v;
    }
    return -1;
}

/// Faults other than the one that a test is about.
struct Faults {
    int flipped = 0;
    int broken = 0;
    int fractional_translations = 0;
    int fractional_singularities = 0;
    int cones = 0;
    int unaligned = 0;
};

void expect_faults(const GridMap& map, const Faults& expected) {
    const GridMapReport report = verify_grid_map(map);
    EXPECT_EQ(report.flipped_triangles, expected.flipped);
    EXPECT_EQ(report.broken_transitions, expected.broken);
    EXPECT_EQ(report.fractional_translations, expected.fractional_translations);
    EXPECT_EQ(report.fractional_singularities, expected.fractional_singularities);
    EXPECT_EQ(report.wrong_cone_angles, expected.cones);
    EXPECT_EQ(report.unaligned_edges, expected.unaligned);
    EXPECT_FALSE(report.valid());
}

TEST(Rotate, QuarterTurnsCompose) {
    const GridMap::Coordinate z = {3, -7};
    EXPECT_EQ(rotate(z, 1), (GridMap::Coordinate{7, 3}));
    for (int a = -4; a < 8; ++a) {
        EXPECT_EQ(rotate(rotate(z, a), 1), rotate(z, a + 1));
        EXPECT_EQ(rotate(rotate(z, a), -a), z);
    }
}

TEST(VerifyGridMap, AcceptsMapsInAnyCharts) {
    std::mt19937 random(1);
    for (const GridMap& map : {cube_map(), rectangle_map()}) {
        EXPECT_TRUE(verify_grid_map(map).valid());
        const auto gauge = test::random_charts(map.topology.triangle_count, 50, random);
        EXPECT_TRUE(verify_grid_map(test::change_charts(map, gauge)).valid());
        EXPECT_TRUE(verify_grid_map(test::jitter_vertices(map, 0.2, 0, random)).valid());
    }
}

TEST(VerifyGridMap, CountsFlippedTriangles) {
    GridMap map = cube_map();
    const int v = regular_inner_vertex(map);
    const int h = map.topology.vertex_half_edge[at(v)];
    // Half a cell beyond the far end of an edge: the triangles at that end turn over.
    const GridMap::Coordinate end = map.corner[at(Topology::next(h))];
    const GridMap::Coordinate from = map.corner[at(h)];
    test::grid_maps::spread(map, h, {2 * end.u - from.u, 2 * end.v - from.v});
    const GridMapReport report = verify_grid_map(map);
    EXPECT_GT(report.flipped_triangles, 0);
    EXPECT_EQ(report.broken_transitions, 0);
    EXPECT_FALSE(report.valid());
}

TEST(VerifyGridMap, CountsTrianglesWithoutAreaAsFlipped) {
    GridMap map = cube_map();
    const int h = map.topology.vertex_half_edge[at(regular_inner_vertex(map))];
    test::grid_maps::spread(map, h, map.corner[at(Topology::next(h))]);
    EXPECT_GE(verify_grid_map(map).flipped_triangles, 2);
}

TEST(VerifyGridMap, CountsEdgesThatDoNotMatchToTheLastBit) {
    GridMap map = cube_map();
    const int v = regular_inner_vertex(map);
    const int h = map.topology.vertex_half_edge[at(v)];
    map.corner[at(h)].u += 1;
    // Two edges of the triangle, seen from both sides.
    expect_faults(map, {.broken = 4});
}

TEST(VerifyGridMap, CountsFractionalTranslations) {
    const GridMap map = cube_map();
    std::vector<GridMap::Transition> gauge(at(map.topology.triangle_count), {0, {0, 0}});
    const int v = regular_inner_vertex(map);
    const int t = Topology::triangle(map.topology.vertex_half_edge[at(v)]);
    gauge[at(t)].translation = {GridMap::one / 4, 0};
    const GridMapReport report = verify_grid_map(test::change_charts(map, gauge));
    EXPECT_EQ(report.fractional_translations, 6);
    EXPECT_EQ(report.broken_transitions, 0);
    EXPECT_EQ(report.flipped_triangles, 0);
    EXPECT_FALSE(report.valid());
}

TEST(VerifyGridMap, CountsSingularitiesOffTheGrid) {
    // By half a cell in both directions: every quarter turn makes whole translations of that.
    expect_faults(shifted(cube_map(), half), {.fractional_singularities = 8});
}

TEST(VerifyGridMap, CountsConesWhoseAngleOnlyLooksRight) {
    // Holonomy is the index modulo four: the angle has to be added up.
    GridMap map = cube_map();
    map.index[singular_vertex(map)] += 4;
    expect_faults(map, {.cones = 1});
    map = cube_map();
    map.index[regular_inner_vertex(map)] = -4;
    expect_faults(map, {.fractional_singularities = 0, .cones = 1});
}

TEST(VerifyGridMap, CountsMissingCornersOfTheBoundary) {
    GridMap map = rectangle_map();
    map.index[singular_vertex(map)] = 0;
    expect_faults(map, {.cones = 1});
}

TEST(VerifyGridMap, CountsBoundaryEdgesOffTheLines) {
    // The four corners leave the grid with them.
    expect_faults(shifted(rectangle_map(), half), {.fractional_singularities = 4, .unaligned = 16});
}

TEST(VerifyGridMap, CountsSlantedBoundaryEdges) {
    GridMap map = rectangle_map();
    for (int v = 0; v < map.topology.vertex_count; ++v) {
        if (!map.topology.is_boundary_vertex(v) || map.index[v] != 0) continue;
        const int h = map.topology.vertex_half_edge[at(v)];
        GridMap::Coordinate z = map.corner[at(h)];
        const GridMap::Coordinate end = map.corner[at(Topology::next(h))];
        (z.u == end.u ? z.u : z.v) += 1;
        test::grid_maps::spread(map, h, z);
        break;
    }
    expect_faults(map, {.unaligned = 2});
}

}  // namespace
}  // namespace kinequad
