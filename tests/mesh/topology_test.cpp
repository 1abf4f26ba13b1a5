#include "kinequad/mesh/topology.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "kinequad/core/error.h"
#include "support/shapes.h"

namespace kinequad {
namespace {

Triangles triangles(const std::vector<std::array<int, 3>>& rows) {
    Triangles F(static_cast<Eigen::Index>(rows.size()), 3);
    for (std::size_t t = 0; t < rows.size(); ++t) {
        F.row(static_cast<Eigen::Index>(t)) << rows[t][0], rows[t][1], rows[t][2];
    }
    return F;
}

/// The message with which `F` is refused; fails the test where it is accepted.
std::string refusal(const Triangles& F, int vertex_count) {
    try {
        build_topology(F, vertex_count);
    } catch (const InputError& error) {
        EXPECT_EQ(error.code(), ExitCode::invalid_mesh);
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << "more than one line";
        return error.what();
    }
    ADD_FAILURE() << "accepted";
    return "";
}

/// `text` holds `part`, said with both where it does not.
void expect_names(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << "\"" << text << "\" does not name " << part;
}

/// Every invariant of a half-edge structure, checked from the definition.
void expect_consistent(const Topology& topology) {
    ASSERT_EQ(topology.origin.size(), 3 * static_cast<std::size_t>(topology.triangle_count));
    ASSERT_EQ(topology.edge_half_edge.size(), static_cast<std::size_t>(topology.edge_count));
    for (std::size_t i = 0; i < topology.origin.size(); ++i) {
        const int h = static_cast<int>(i);
        EXPECT_EQ(Topology::previous(Topology::next(h)), h);
        EXPECT_EQ(Topology::triangle(Topology::next(h)), Topology::triangle(h));
        const int other = topology.twin[i];
        const int lower = topology.edge_half_edge[static_cast<std::size_t>(topology.edge[i])];
        if (other < 0) {
            EXPECT_EQ(lower, h);
            continue;
        }
        EXPECT_EQ(topology.twin[static_cast<std::size_t>(other)], h);
        EXPECT_EQ(topology.origin[static_cast<std::size_t>(other)], topology.target(h));
        EXPECT_EQ(topology.target(other), topology.origin[i]);
        EXPECT_EQ(topology.edge[static_cast<std::size_t>(other)], topology.edge[i]);
        EXPECT_EQ(lower, std::min(h, other));
    }
    std::size_t corners = 0;
    for (int v = 0; v < topology.vertex_count; ++v) {
        const std::vector<int> ring = outgoing_half_edges(topology, v);
        corners += ring.size();
        for (std::size_t i = 0; i < ring.size(); ++i) {
            EXPECT_EQ(topology.origin[static_cast<std::size_t>(ring[i])], v);
            if (i > 0) {
                EXPECT_EQ(topology.rotate_clockwise(ring[i]), ring[i - 1]);
            }
        }
        if (topology.is_boundary_vertex(v)) {
            EXPECT_EQ(topology.rotate_clockwise(ring.front()), -1);
            EXPECT_EQ(topology.rotate_counter_clockwise(ring.back()), -1);
        }
    }
    EXPECT_EQ(corners, topology.origin.size()) << "a triangle is in no fan";
}

TEST(Topology, InvariantsHoldOnEveryShape) {
    for (const TriangleMesh& mesh : {test::tetrahedron(), test::cube(2), test::sphere(2),
                                     test::torus(7, 5), test::square(3), test::cylinder(5, 2)}) {
        expect_consistent(build_topology(mesh.F, static_cast<int>(mesh.V.rows())));
    }
}

TEST(Topology, OneTriangleIsADisc) {
    const Topology topology = build_topology(triangles({{0, 1, 2}}), 3);
    expect_consistent(topology);
    const SurfaceCounts counts = count_surface(topology);
    EXPECT_EQ(counts.edges, 3);
    EXPECT_EQ(counts.euler_characteristic, 1);
    EXPECT_EQ(boundary_loops(topology), (std::vector<std::vector<int>>{{0, 1, 2}}));
}

TEST(Topology, AnEmptyMeshAndIsolatedVerticesAreNotCounted) {
    EXPECT_EQ(count_surface(build_topology(Triangles(0, 3), 0)).components, 0);
    const Topology topology = build_topology(triangles({{1, 2, 4}}), 6);
    expect_consistent(topology);
    EXPECT_EQ(count_surface(topology).vertices, 3);
    EXPECT_TRUE(outgoing_half_edges(topology, 0).empty());
    EXPECT_FALSE(topology.is_boundary_vertex(0));
    EXPECT_TRUE(topology.is_boundary_vertex(1));
}

TEST(Topology, EulerCharacteristicAddsUpOverComponents) {
    const TriangleMesh ball = test::sphere(1);
    const TriangleMesh ring = test::torus(6, 5);
    const int shift = static_cast<int>(ball.V.rows());
    Triangles F(ball.F.rows() + ring.F.rows(), 3);
    F << ball.F, (ring.F.array() + shift).matrix();
    const Topology topology = build_topology(F, shift + static_cast<int>(ring.V.rows()));
    const SurfaceCounts counts = count_surface(topology);
    EXPECT_EQ(counts.components, 2);
    EXPECT_EQ(counts.euler_characteristic, 2);
    const std::vector<int> component = triangle_components(topology);
    EXPECT_EQ(component.front(), 0);
    EXPECT_EQ(component.back(), 1);
}

TEST(Topology, BoundaryLoopsRunWithTheSurfaceOnTheirLeft) {
    const Topology topology = build_topology(test::cylinder(5, 2).F, 15);
    const auto loops = boundary_loops(topology);
    ASSERT_EQ(loops.size(), 2U);
    for (const auto& loop : loops) {
        EXPECT_EQ(loop.size(), 5U);
        for (std::size_t i = 0; i < loop.size(); ++i) {
            EXPECT_EQ(topology.twin[static_cast<std::size_t>(loop[i])], -1);
            EXPECT_EQ(topology.target(loop[i]),
                      topology.origin[static_cast<std::size_t>(loop[(i + 1) % loop.size()])]);
        }
    }
}

TEST(Topology, RefusesAnIndexOutOfRange) {
    expect_names(refusal(triangles({{0, 1, 2}, {0, 2, 7}}), 4), "triangle 1 names vertex 7");
    expect_names(refusal(triangles({{0, 1, -1}}), 3), "triangle 0 names vertex -1");
}

TEST(Topology, RefusesATriangleThatRepeatsAVertex) {
    expect_names(refusal(triangles({{0, 1, 2}, {2, 3, 2}}), 4), "triangle 1 repeats a vertex");
}

TEST(Topology, RefusesAnEdgeOfThreeTriangles) {
    const std::string message = refusal(triangles({{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}), 5);
    expect_names(message, "edge 0-1 is non-manifold");
    expect_names(message, "triangles 0, 1 and 2");
}

TEST(Topology, RefusesADoubledTriangle) {
    expect_names(refusal(triangles({{0, 1, 2}, {1, 2, 0}}), 3), "triangles 0 and 1");
}

TEST(Topology, RefusesNeighboursThatDisagreeOnOrientation) {
    expect_names(refusal(triangles({{0, 1, 2}, {0, 1, 3}}), 4),
                 "triangles 0 and 1 run along edge 0-1 in the same direction");
}

TEST(Topology, RefusesAMoebiusStrip) {
    // Six triangles around, the last glued to the first with a twist.
    const Triangles F =
        triangles({{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {4, 3, 5}, {4, 5, 1}, {1, 5, 0}});
    expect_names(refusal(F, 6), "orient the faces consistently");
}

TEST(Topology, RefusesABowTieVertex) {
    expect_names(refusal(triangles({{0, 1, 2}, {0, 3, 4}}), 5), "vertex 0 is non-manifold");
    // Two closed tetrahedra that touch in vertex 3: no boundary gives it away.
    const Triangles F = triangles(
        {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {4, 6, 5}, {4, 5, 3}, {5, 6, 3}, {6, 4, 3}});
    expect_names(refusal(F, 7), "vertex 3 is non-manifold");
}

TEST(Topology, RefusesAClosedFanWithAFinAtItsCentre) {
    // Vertex 3 is the centre of a closed fan and a corner of one triangle more.
    const Triangles F = triangles({{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {3, 4, 5}});
    expect_names(refusal(F, 6), "vertex 3 is non-manifold");
}

TEST(Topology, CountsDoNotDependOnTheNumbering) {
    EXPECT_TRUE(rc::check("counts survive renumbering", [] {
        const TriangleMesh mesh = *rc::gen::element(test::torus(5, 4), test::cylinder(4, 3));
        const auto n = static_cast<std::size_t>(mesh.V.rows());
        std::vector<int> renumbered(n);
        std::iota(renumbered.begin(), renumbered.end(), 0);
        const auto swaps = *rc::gen::container<std::vector<std::pair<std::size_t, std::size_t>>>(
            n, rc::gen::pair(rc::gen::inRange<std::size_t>(0, n),
                             rc::gen::inRange<std::size_t>(0, n)));
        for (const auto& [a, b] : swaps) std::swap(renumbered[a], renumbered[b]);
        Triangles F = mesh.F;
        for (Eigen::Index i = 0; i < F.rows(); ++i) {
            const int turn = *rc::gen::inRange(0, 3);
            for (int k = 0; k < 3; ++k) {
                F(i, k) = renumbered[static_cast<std::size_t>(mesh.F(i, (k + turn) % 3))];
            }
        }
        const SurfaceCounts before = count_surface(build_topology(mesh.F, static_cast<int>(n)));
        const Topology topology = build_topology(F, static_cast<int>(n));
        expect_consistent(topology);
        const SurfaceCounts after = count_surface(topology);
        RC_ASSERT(before.edges == after.edges);
        RC_ASSERT(before.boundary_loops == after.boundary_loops);
        RC_ASSERT(before.euler_characteristic == after.euler_characteristic);
    }));
}

}  // namespace
}  // namespace kinequad
