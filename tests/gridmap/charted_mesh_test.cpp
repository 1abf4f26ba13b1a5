#include "kinequad/gridmap/charted_mesh.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>
#include <set>

#include "gridmap/prepared_map.h"
#include "kinequad/field/singularities.h"

namespace kinequad {
namespace {

double cross(Complex a, Complex b) { return std::imag(std::conj(a) * b); }

double chart_area(const ChartedMesh& mesh) {
    double sum = 0;
    for (int h = 0; h < 3 * mesh.triangle_count(); h += 3) {
        sum +=
            cross(test::displacement(mesh.target, h), test::displacement(mesh.target, h + 1)) / 2;
    }
    return sum;
}

void expect_consistent(const ChartedMesh& mesh) {
    const Topology topology = build_topology(mesh.triangles(), mesh.vertex_count);
    for (int h = 0; h < 3 * mesh.triangle_count(); ++h) {
        const int other = mesh.twin[at(h)];
        ASSERT_EQ(topology.twin[at(h)], other);
        if (other < 0) {
            EXPECT_TRUE(mesh.is_boundary[at(mesh.origin[at(h)])]);
            continue;
        }
        EXPECT_EQ((mesh.rotation[at(h)] + mesh.rotation[at(other)]) & 3, 0);
        // Charts are isometric: both sides see the same length.
        EXPECT_NEAR(std::abs(test::displacement(mesh.target, h)),
                    std::abs(test::displacement(mesh.target, other)), 1e-9);
    }
}

/// Turns of the field around an interior vertex, in quarters, modulo 4: -index.
int turns_around(const ChartedMesh& mesh, int start) {
    int turns = 0;
    int h = start;
    do {
        const int in = Topology::previous(h);
        turns += mesh.rotation[at(in)];
        h = mesh.twin[at(in)];
    } while (h != start);
    return turns & 3;
}

void expect_indices_as_holonomy(const ChartedMesh& mesh) {
    const std::vector<int> first = mesh.first_half_edges();
    for (int v = 0; v < mesh.vertex_count; ++v) {
        if (mesh.is_boundary[at(v)]) continue;
        EXPECT_EQ((turns_around(mesh, first[at(v)]) - mesh.index[at(v)]) & 3, 0) << "vertex " << v;
    }
}

ChartedMesh charts_of(const test::Surface& surface) {
    return build_charts(surface.topology, surface.metric, test::field_of(surface), 0.2);
}

TEST(BuildCharts, RotationsGiveTheIndices) {
    for (const test::Surface& surface : test::map_surfaces()) {
        SCOPED_TRACE(surface.name);
        const ChartedMesh mesh = charts_of(surface);
        expect_consistent(mesh);
        expect_indices_as_holonomy(mesh);
        EXPECT_NEAR(chart_area(mesh), triangle_areas(surface.topology, surface.metric).sum() / 0.04,
                    1e-8);
    }
}

TEST(SplitEdge, KeepsTopologyAreaAndRotations) {
    std::mt19937 random(3);
    for (const test::Surface& surface : test::map_surfaces()) {
        SCOPED_TRACE(surface.name);
        ChartedMesh mesh = charts_of(surface);
        const double area = chart_area(mesh);
        const SurfaceCounts before = count_surface(surface.topology);
        std::uniform_real_distribution<double> fraction(0.2, 0.8);
        for (int i = 0; i < 60; ++i) {
            const int h =
                std::uniform_int_distribution<int>(0, 3 * mesh.triangle_count() - 1)(random);
            const int triangles = mesh.triangle_count();
            const int sides = mesh.twin[at(h)] < 0 ? 1 : 2;
            const int start = mesh.origin[at(h)];
            const int v = mesh.split_edge(h, fraction(random));
            EXPECT_EQ(v, mesh.vertex_count - 1);
            EXPECT_EQ(mesh.triangle_count(), triangles + sides);
            EXPECT_EQ(mesh.origin[at(h)], start);
            EXPECT_EQ(mesh.origin[at(Topology::next(h))], v);
        }
        expect_consistent(mesh);
        expect_indices_as_holonomy(mesh);
        EXPECT_NEAR(chart_area(mesh), area, 1e-9 * area);
        const SurfaceCounts after =
            count_surface(build_topology(mesh.triangles(), mesh.vertex_count));
        EXPECT_EQ(after.euler_characteristic, before.euler_characteristic);
        EXPECT_EQ(after.boundary_loops, before.boundary_loops);
        EXPECT_EQ(after.components, before.components);
    }
}

TEST(SplitEdge, NewCornersLieWhereTheParentSaysTheyDo) {
    const test::Surface surface = test::surface_of(test::sphere(2));
    ChartedMesh mesh = charts_of(surface);
    std::mt19937 random(7);
    for (int i = 0; i < 200; ++i) {
        const int h = std::uniform_int_distribution<int>(0, 3 * mesh.triangle_count() - 1)(random);
        mesh.split_edge(h, 0.3);
    }
    const ChartedMesh original = charts_of(surface);
    for (int h = 0; h < 3 * mesh.triangle_count(); ++h) {
        const Vector3 b = mesh.barycentric[at(h)];
        EXPECT_NEAR(b.sum(), 1, 1e-12);
        Complex expected = 0;
        for (int k = 0; k < 3; ++k)
            expected += b[k] * original.target[at(3 * mesh.parent[at(h / 3)] + k)];
        EXPECT_LT(std::abs(expected - mesh.target[at(h)]), 1e-9);
    }
}

TEST(SplitEdge, FractionIsMeasuredFromTheOrigin) {
    const test::Surface surface = test::surface_of(test::tetrahedron());
    ChartedMesh mesh = charts_of(surface);
    const int other = mesh.twin[0];
    const double length = std::abs(test::displacement(mesh.target, 0));
    mesh.split_edge(0, 0.25);
    EXPECT_NEAR(std::abs(test::displacement(mesh.target, 0)), 0.25 * length, 1e-12);
    EXPECT_NEAR(std::abs(test::displacement(mesh.target, other)), 0.75 * length, 1e-12);
}

TEST(SeparateSingularities, NoInnerEdgeJoinsTwo) {
    // All eight corners of a cube without inner vertices are singular, and all edges join two.
    ChartedMesh mesh = charts_of(test::surface_of(test::cube(1)));
    EXPECT_GT(separate_singularities(mesh), 0);
    expect_consistent(mesh);
    expect_indices_as_holonomy(mesh);
    for (int h = 0; h < 3 * mesh.triangle_count(); ++h) {
        const int a = mesh.origin[at(h)];
        const int b = mesh.origin[at(Topology::next(h))];
        EXPECT_FALSE(mesh.index[at(a)] != 0 && mesh.index[at(b)] != 0);
    }
    EXPECT_EQ(separate_singularities(mesh), 0);
}

TEST(CutToDiscs, LeavesNoTurnOffTheCutAndOneDiscAComponent) {
    for (const test::Surface& surface : test::map_surfaces()) {
        SCOPED_TRACE(surface.name);
        const test::PreparedMap prepared = test::prepare(surface, 300);
        const ChartedMesh& mesh = prepared.mesh;
        const std::vector<char>& is_cut = prepared.cut.is_cut;
        expect_consistent(mesh);
        expect_indices_as_holonomy(mesh);

        const int triangles = mesh.triangle_count();
        std::vector<int> group(at(triangles));
        std::iota(group.begin(), group.end(), 0);
        const auto root = [&](int t) {
            while (group[at(t)] != t) t = group[at(t)];
            return t;
        };
        std::vector<int> cut_degree(at(mesh.vertex_count), 0);
        for (int h = 0; h < 3 * triangles; ++h) {
            const int other = mesh.twin[at(h)];
            if (other < 0) {
                EXPECT_FALSE(is_cut[at(h)]);
                continue;
            }
            EXPECT_EQ(is_cut[at(h)], is_cut[at(other)]);
            if (is_cut[at(h)]) {
                ++cut_degree[at(mesh.origin[at(h)])];
                continue;
            }
            EXPECT_EQ(mesh.rotation[at(h)], 0);
            group[at(root(h / 3))] = root(other / 3);
        }
        std::set<int> parts;
        for (int t = 0; t < triangles; ++t) parts.insert(root(t));
        const SurfaceCounts counts = count_surface(surface.topology);
        EXPECT_EQ(static_cast<int>(parts.size()), counts.components);

        // What is left when the cut is opened: a disc a component, by its Euler characteristic. A
        // vertex falls into as many copies as the cut has edges there, one more on the boundary.
        int copies = 0;
        int singular_off_cut = 0;
        for (int v = 0; v < mesh.vertex_count; ++v) {
            const bool open = mesh.is_boundary[at(v)] != 0;
            copies += open ? cut_degree[at(v)] + 1 : std::max(1, cut_degree[at(v)]);
            if (!open && cut_degree[at(v)] == 0 && mesh.index[at(v)] != 0) ++singular_off_cut;
            // No loose ends at regular vertices.
            if (!open && !prepared.nodes[at(v)]) {
                EXPECT_NE(cut_degree[at(v)], 1);
            }
        }
        EXPECT_EQ(singular_off_cut, 0);
        int edges_of_pieces = 0;
        for (int h = 0; h < 3 * triangles; ++h) {
            edges_of_pieces += mesh.twin[at(h)] < 0 || is_cut[at(h)] ? 2 : 1;
        }
        EXPECT_EQ(copies - edges_of_pieces / 2 + triangles, counts.components);
    }
}

}  // namespace
}  // namespace kinequad
