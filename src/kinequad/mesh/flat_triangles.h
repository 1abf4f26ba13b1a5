#pragma once

#include "kinequad/core/types.h"

namespace kinequad {

/// Whether triangle `t` of `F` has no area in the pose `V` up to rounding: less than 1e-12 of its
/// longest side squared. Scale and distance from the origin do not matter.
bool is_flat_triangle(const Triangles& F, const Positions& V, int t);

}  // namespace kinequad
