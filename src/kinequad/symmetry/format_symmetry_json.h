#pragma once

#include <string>

#include "kinequad/symmetry/symmetry_map.h"

namespace kinequad {

/// The text of symmetry.json: {"image": [[triangle, b0, b1, b2], ...] one a vertex, "stationary":
/// polylines of such points, "method", "quality"}, with a line feed at its end.
std::string format_symmetry_json(const SymmetryMap& map);

}  // namespace kinequad
