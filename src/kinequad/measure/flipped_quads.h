#pragma once

#include "kinequad/core/context.h"
#include "kinequad/io/polygons.h"
#include "kinequad/mesh/closest_points.h"

namespace kinequad {

/// Number of quads of `faces` in the pose `X` (v x 3) whose normal points against that of the
/// triangle of `input` nearest to the mean of their corners. Where that are more than half of them,
/// the mesh is taken to be oriented the other way round, and the others are counted.
int count_flipped_quads(const Positions& X, const Polygons& faces, const ClosestPoints& input,
                        const Context& context = {});

}  // namespace kinequad
