#pragma once

#include <array>

namespace kinequad::synth_detail {

/// How the surface passes through a cell of a grid, for each of the 256 ways its corners can lie
/// inside or outside. Corner `x + 2 y + 4 z`; the edge along axis `a` has number `4 a + u + 2 v`,
/// where `u` and `v` are its place along the axes that follow `a` cyclically.
struct CellCase {
    int piece_count = 0;
    std::array<int, 12> piece{};  ///< of every edge, -1 where it is not crossed
};

/// The case of corners whose bits in `mask` are set inside. Where a side of the cell is crossed
/// four times, inside corners are kept apart, from both cells alike.
const CellCase& cell_case(unsigned mask);

/// The two corners of an edge.
std::array<int, 2> cell_edge_corners(int edge);

}  // namespace kinequad::synth_detail
