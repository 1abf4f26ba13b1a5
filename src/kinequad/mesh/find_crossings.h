#pragma once

#include <array>
#include <vector>

#include "kinequad/core/context.h"
#include "kinequad/core/types.h"

namespace kinequad {

/// Pairs (ascending) of triangles of `F` (m x 3) over `V` (n x 3) that pass through one another: a
/// side of one meets the inside of the other. Pairs with a common vertex, and triangles in one
/// plane, are none. At most `most` pairs: the search ends there, then the list need not hold the
/// lowest. Indices have to be in range. Throws `Cancelled`.
std::vector<std::array<int, 2>> find_crossing_triangles(const Triangles& F, const Positions& V,
                                                        int most, const Context& context);

}  // namespace kinequad
