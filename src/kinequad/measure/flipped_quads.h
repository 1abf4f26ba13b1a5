#pragma once

#include <vector>

#include "kinequad/core/context.h"
#include "kinequad/io/polygons.h"
#include "kinequad/mesh/closest_points.h"

namespace kinequad {

/// Number of quads of `faces` in the pose `X` (v x 3) whose normal points against that of the
/// triangle of `input` nearest to the mean of their corners. Where that are more than half of them,
/// the mesh is taken to be oriented the other way round, and the others are counted. `hints` (v, or
/// empty) are triangles of the input that are probably near to the vertices, -1 for none: they make
/// the search quick and change no result.
int count_flipped_quads(const Positions& X, const Polygons& faces, const ClosestPoints& input,
                        const std::vector<int>& hints = {}, const Context& context = {});

}  // namespace kinequad
