#include "kinequad/extract/part_parallel_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "kinequad/extract/quad_topology.h"

namespace kinequad::test {
namespace {

using extraction::Cells;
using extraction::part_parallel_edges;

constexpr std::array<std::array<int, 4>, 6> cube_faces = {
    {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};

/// Two cubes slit open along their edge 0-1 and joined there: a sphere of twelve quads in which two
/// edges join vertices 0 and 1. As if read at twice the density; `is_on_line` tells which of the
/// two lie on lines.
Cells joined_cubes(std::array<bool, 2> is_on_line) {
    Cells cells;
    int count = 14;
    std::map<std::array<int, 3>, int> middles;
    std::vector<std::array<int, 4>> quarters;
    std::array<int, 2> slit_middle{};
    for (int c = 0; c < 2; ++c) {
        for (const auto& face : cube_faces) {
            std::array<int, 4> v{};
            std::array<int, 4> m{};
            for (std::size_t k = 0; k < 4; ++k) v[k] = face[k] + (c == 1 && face[k] > 1 ? 6 : 0);
            for (std::size_t k = 0; k < 4; ++k) {
                const int from = v[k];
                const int to = v[(k + 1) % 4];
                // The slit: what leaves 0 for 1 in one cube lies across what leaves 1 for 0 in the
                // other.
                const bool is_slit = std::max(from, to) == 1;
                const int side = is_slit ? (c + (from == 0 ? 0 : 1)) % 2 : c;
                const auto [middle, is_new] =
                    middles.try_emplace({std::min(from, to), std::max(from, to), side}, count);
                if (is_new) ++count;
                m[k] = middle->second;
                if (is_slit) slit_middle[static_cast<std::size_t>(side)] = m[k];
            }
            const int centre = count++;
            for (std::size_t k = 0; k < 4; ++k) {
                quarters.push_back({v[k], m[k], centre, m[(k + 3) % 4]});
            }
        }
    }
    cells.mesh.Q.resize(static_cast<Eigen::Index>(quarters.size()), 4);
    cells.odd_coordinates.assign(static_cast<std::size_t>(count), 0);
    for (std::size_t q = 0; q < quarters.size(); ++q) {
        for (std::size_t k = 0; k < 4; ++k) {
            cells.mesh.Q(static_cast<Eigen::Index>(q), static_cast<Eigen::Index>(k)) =
                quarters[q][k];
            cells.odd_coordinates[static_cast<std::size_t>(quarters[q][k])] =
                static_cast<char>(k == 0   ? 0
                                  : k == 2 ? 2
                                           : 1);
        }
    }
    for (int v = 0; v < count; ++v) {
        // The triangle tells the vertex.
        cells.mesh.vertex.push_back({v, Vector3::UnitX()});
    }
    cells.is_on_line.assign(static_cast<std::size_t>(count), 0);
    for (std::size_t i = 0; i < 2; ++i) {
        if (is_on_line[i]) cells.is_on_line[static_cast<std::size_t>(slit_middle[i])] = 1;
    }
    return cells;
}

/// Whether the mesh has a vertex in the middle of the edge `i` between vertices 0 and 1.
bool has_middle_of(const QuadMesh& mesh, int i) {
    std::array<bool, 2> only{};
    only[static_cast<std::size_t>(i)] = true;
    const Cells cells = joined_cubes(only);
    return std::any_of(mesh.vertex.begin(), mesh.vertex.end(), [&](const SurfacePoint& point) {
        return cells.is_on_line[static_cast<std::size_t>(point.triangle)] != 0;
    });
}

TEST(PartParallelEdges, ChangesTheTwoQuadsAtOneOfThem) {
    ASSERT_EQ(joined_cubes({}).mesh.vertex.size(), 14U + 24U + 12U);
    const auto parted = part_parallel_edges(joined_cubes({}));
    ASSERT_TRUE(parted);
    EXPECT_EQ(parted->parted_edges, 1);
    EXPECT_EQ(parted->mesh.Q.rows(), 13);
    EXPECT_EQ(parted->mesh.vertex.size(), 15U);
    // Throws where the quads are no manifold, oriented mesh.
    const QuadTopology topology = build_quad_topology(parted->mesh.Q, 15);
    EXPECT_EQ(15 - topology.edge_count + topology.quad_count, 2);
    EXPECT_NE(has_middle_of(parted->mesh, 0), has_middle_of(parted->mesh, 1));
}

TEST(PartParallelEdges, KeepsEdgesOnLines) {
    for (const int line : {0, 1}) {
        std::array<bool, 2> is_on_line{};
        is_on_line[static_cast<std::size_t>(line)] = true;
        const auto parted = part_parallel_edges(joined_cubes(is_on_line));
        ASSERT_TRUE(parted);
        EXPECT_FALSE(has_middle_of(parted->mesh, line));
        EXPECT_TRUE(has_middle_of(parted->mesh, 1 - line));
    }
    EXPECT_FALSE(part_parallel_edges(joined_cubes({true, true})));
}

}  // namespace
}  // namespace kinequad::test
