#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "kinequad/extract/extract_quads.h"
#include "kinequad/extract/quad_topology.h"
#include "kinequad/extract/verify_quad_mesh.h"
#include "support/grid_maps.h"

namespace kinequad::test {

/// Extracts from a map that has to be valid, and verifies what comes out.
inline QuadMesh extract_valid(const GridMap& map) {
    EXPECT_TRUE(verify_grid_map(map).valid());
    QuadMesh mesh = extract_quads(map, Context{});
    EXPECT_NO_THROW(require_valid(verify_quad_mesh(mesh, map.topology)));
    return mesh;
}

/// Number of vertices of each irregular kind: valence, negative on the boundary.
inline std::map<int, int> irregular_valences(const QuadMesh& mesh) {
    const auto topology = build_quad_topology(mesh.Q, static_cast<int>(mesh.vertex.size()));
    std::map<int, int> counts;
    for (int v = 0; v < topology.vertex_count; ++v) {
        if (!topology.is_irregular_vertex(v)) continue;
        const int valence = topology.valence[static_cast<std::size_t>(v)];
        ++counts[topology.is_boundary_vertex(v) ? -valence : valence];
    }
    return counts;
}

inline Positions positions_of(const QuadMesh& mesh, const TriangleMesh& surface) {
    Positions V(static_cast<Eigen::Index>(mesh.vertex.size()), 3);
    for (Eigen::Index i = 0; i < V.rows(); ++i) {
        V.row(i) =
            position_of(mesh.vertex[static_cast<std::size_t>(i)], surface.V, surface.F).transpose();
    }
    return V;
}

/// Quads as sorted cycles of vertices, each starting at its lowest, after renaming vertices.
inline std::vector<std::array<int, 4>> quad_cycles(const Quads& Q, const std::vector<int>& name) {
    std::vector<std::array<int, 4>> cycles;
    for (Eigen::Index q = 0; q < Q.rows(); ++q) {
        std::array<int, 4> cycle{};
        for (int k = 0; k < 4; ++k) {
            cycle[static_cast<std::size_t>(k)] = name[static_cast<std::size_t>(Q(q, k))];
        }
        std::rotate(cycle.begin(), std::min_element(cycle.begin(), cycle.end()), cycle.end());
        cycles.push_back(cycle);
    }
    std::sort(cycles.begin(), cycles.end());
    return cycles;
}

/// Expects two quad meshes to be the same but for the numbering, vertices being matched in space.
inline void expect_same_quads(const Quads& Q, const Positions& V, const Quads& other_Q,
                              const Positions& other_V) {
    ASSERT_EQ(V.rows(), other_V.rows());
    ASSERT_EQ(Q.rows(), other_Q.rows());
    std::vector<int> own_name;
    std::vector<int> match;
    for (Eigen::Index i = 0; i < V.rows(); ++i) {
        Eigen::Index nearest = 0;
        const double distance = (other_V.rowwise() - V.row(i)).rowwise().norm().minCoeff(&nearest);
        ASSERT_LT(distance, 1e-7);
        match.push_back(static_cast<int>(nearest));
        own_name.push_back(static_cast<int>(i));
    }
    EXPECT_EQ(quad_cycles(Q, match), quad_cycles(other_Q, own_name));
}

}  // namespace kinequad::test
