#include "kinequad/extract/quad_topology.h"

#include <gtest/gtest.h>

#include "kinequad/core/error.h"

namespace kinequad::test {
namespace {

Quads quads(std::initializer_list<std::array<int, 4>> rows) {
    Quads Q(static_cast<Eigen::Index>(rows.size()), 4);
    Eigen::Index q = 0;
    for (const auto& row : rows) Q.row(q++) << row[0], row[1], row[2], row[3];
    return Q;
}

Quads cube_quads() {
    return quads(
        {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}});
}

TEST(QuadTopology, Cube) {
    const QuadTopology topology = build_quad_topology(cube_quads(), 8);
    EXPECT_EQ(topology.edge_count, 12);
    EXPECT_EQ(count_irregular_vertices(topology), 8);
    EXPECT_EQ(topology.neighbor.size(), 24U);
    for (int h = 0; h < 24; ++h) {
        const int other = topology.twin[static_cast<std::size_t>(h)];
        ASSERT_GE(other, 0);
        EXPECT_EQ(topology.twin[static_cast<std::size_t>(other)], h);
        EXPECT_EQ(topology.target(h), topology.origin[static_cast<std::size_t>(other)]);
        EXPECT_EQ(topology.edge[static_cast<std::size_t>(h)],
                  topology.edge[static_cast<std::size_t>(other)]);
        EXPECT_EQ(QuadTopology::previous(QuadTopology::next(h)), h);
    }
    for (int v = 0; v < 8; ++v) EXPECT_EQ(topology.valence[static_cast<std::size_t>(v)], 3);
}

TEST(QuadTopology, GridOfTwoByTwo) {
    // 6 7 8
    // 3 4 5
    // 0 1 2
    const QuadTopology topology =
        build_quad_topology(quads({{0, 1, 4, 3}, {1, 2, 5, 4}, {3, 4, 7, 6}, {4, 5, 8, 7}}), 10);
    EXPECT_EQ(topology.edge_count, 12);
    EXPECT_FALSE(topology.is_boundary_vertex(4));
    EXPECT_TRUE(topology.is_boundary_vertex(1));
    EXPECT_FALSE(topology.is_boundary_vertex(9));
    EXPECT_FALSE(topology.is_irregular_vertex(1));
    EXPECT_TRUE(topology.is_irregular_vertex(0));
    EXPECT_FALSE(topology.is_irregular_vertex(9));
    EXPECT_EQ(count_irregular_vertices(topology), 4);
    EXPECT_EQ(topology.valence, (std::vector<int>{2, 3, 2, 3, 4, 3, 2, 3, 2, 0}));
    // Counter-clockwise; on the boundary from one boundary neighbour to the other.
    const auto neighbors_of = [&](int v) {
        const auto begin = topology.neighbor.begin();
        return std::vector<int>(begin + topology.first_neighbor[static_cast<std::size_t>(v)],
                                begin + topology.first_neighbor[static_cast<std::size_t>(v) + 1]);
    };
    EXPECT_EQ(neighbors_of(1), (std::vector<int>{2, 4, 0}));
    EXPECT_EQ(neighbors_of(4), (std::vector<int>{3, 1, 5, 7}));
    EXPECT_EQ(neighbors_of(9), std::vector<int>{});
}

TEST(QuadTopology, RefusesWhatIsNoManifold) {
    EXPECT_THROW(build_quad_topology(quads({{0, 1, 2, 4}}), 4), InputError);
    EXPECT_THROW(build_quad_topology(quads({{0, 1, 2, -1}}), 4), InputError);
    EXPECT_THROW(build_quad_topology(quads({{0, 1, 2, 1}}), 4), InputError);
    // Two quads the same way round along 1-2.
    EXPECT_THROW(build_quad_topology(quads({{0, 1, 2, 3}, {1, 2, 4, 5}}), 6), InputError);
    // Three quads on 0-1.
    EXPECT_THROW(build_quad_topology(quads({{0, 1, 2, 3}, {1, 0, 4, 5}, {0, 1, 6, 7}}), 8),
                 InputError);
    // Two quads that touch in vertex 0 alone.
    EXPECT_THROW(build_quad_topology(quads({{0, 1, 2, 3}, {0, 4, 5, 6}}), 7), InputError);
}

}  // namespace
}  // namespace kinequad::test
