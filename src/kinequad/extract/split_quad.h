#pragma once

#include <array>
#include <vector>

namespace kinequad::extraction {

/// Which of the pairs of opposite edges of a quad are split in their middles.
struct SplitEdges {
    bool even = false;  ///< from corner 0 to 1 and from 2 to 3
    bool odd = false;   ///< from corner 1 to 2 and from 3 to 0
};

/// The one, two or four quads that a quad with corners `v` is split into; `m` (4) are the middles
/// of its edges, from corner k to k + 1, and `centre` its own: both are read where edges are split.
std::vector<std::array<int, 4>> split_quad(const std::array<int, 4>& v, const std::array<int, 4>& m,
                                           int centre, SplitEdges edges);

}  // namespace kinequad::extraction
