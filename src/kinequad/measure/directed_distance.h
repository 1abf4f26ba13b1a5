#pragma once

#include <vector>

#include "kinequad/measure/surface_distance.h"

namespace kinequad {

/// Distance from the points of the surface `V`, `F` to the surface `target`. `diagonal` is what 100
/// % are. `hints` holds for every vertex (n) a triangle of the target that is probably near to it,
/// or -1, and is replaced by the nearest one. docs/measures.md says how and proves the bound.
DirectedDistance measure_directed_distance(const Positions& V, const Triangles& F,
                                           const ClosestPoints& target, double diagonal,
                                           const DistanceOptions& options, std::vector<int>& hints,
                                           const Context& context);

}  // namespace kinequad
