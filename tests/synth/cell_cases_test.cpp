#include "kinequad/synth/cell_cases.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>

namespace kinequad::synth_detail {
namespace {

TEST(CellCase, CrossedEdgesAreThoseWhoseCornersDiffer) {
    for (unsigned mask = 0; mask < 256; ++mask) {
        const CellCase& at = cell_case(mask);
        for (int edge = 0; edge < 12; ++edge) {
            const auto [a, b] = cell_edge_corners(edge);
            EXPECT_EQ(std::popcount(static_cast<unsigned>(a ^ b)), 1);
            const bool crossed = (mask >> a & 1U) != (mask >> b & 1U);
            const int piece = at.piece[static_cast<std::size_t>(edge)];
            EXPECT_EQ(piece >= 0, crossed) << mask << ' ' << edge;
            EXPECT_LT(piece, at.piece_count);
        }
    }
}

TEST(CellCase, EveryPieceIsACycleOfAtLeastThreeEdges) {
    for (unsigned mask = 0; mask < 256; ++mask) {
        const CellCase& at = cell_case(mask);
        std::array<int, 4> edges{};
        for (const int piece : at.piece) {
            if (piece >= 0) ++edges[static_cast<std::size_t>(piece)];
        }
        for (int piece = 0; piece < at.piece_count; ++piece) {
            EXPECT_GE(edges[static_cast<std::size_t>(piece)], 3) << mask;
        }
    }
}

TEST(CellCase, KnownNumbersOfPieces) {
    EXPECT_EQ(cell_case(0x00).piece_count, 0);
    EXPECT_EQ(cell_case(0xFF).piece_count, 0);
    EXPECT_EQ(cell_case(0x01).piece_count, 1);  // one corner
    EXPECT_EQ(cell_case(0x0F).piece_count, 1);  // one side
    EXPECT_EQ(cell_case(0x81).piece_count, 2);  // opposite corners
    EXPECT_EQ(cell_case(0x09).piece_count, 2);  // across a side: inside corners stay apart
    EXPECT_EQ(cell_case(0xF6).piece_count, 1);  // and outside corners are joined
    EXPECT_EQ(cell_case(0x69).piece_count, 4);  // every second corner
}

}  // namespace
}  // namespace kinequad::synth_detail
