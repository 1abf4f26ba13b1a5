#pragma once

#include "kinequad/measure/surface_distance.h"

namespace kinequad {

/// Distance from the points of the surface `V`, `F` to the surface `target`. `diagonal` is what 100
/// % are. `hints` may be empty or those of another frame, and are replaced by those of this one.
/// docs/measures.md says how and proves the bound.
DirectedDistance measure_directed_distance(const Positions& V, const Triangles& F,
                                           const ClosestPoints& target, double diagonal,
                                           const DistanceOptions& options, DistanceHints& hints,
                                           const Context& context);

}  // namespace kinequad
