#pragma once

#include <cstdint>

#include "kinequad/gridmap/grid_map.h"

namespace kinequad::extraction {

/// Checks exactly all that tracing relies on: array sizes, coordinates within 2^30 cells of the
/// origin, positive triangles, transitions that match bit for bit with whole translations, boundary
/// edges on integer lines, and integer coordinates wherever the cone angle of a vertex is not that
/// of a regular one. The cone angle is counted in axis directions around the vertex, so no rounding
/// is involved.
///
/// Returns a bound on the number of triangles that a step of one cell along an integer line can
/// cross. Throws `GridMapError` naming the first element at fault.
std::int64_t require_extractable(const GridMap& map);

}  // namespace kinequad::extraction
