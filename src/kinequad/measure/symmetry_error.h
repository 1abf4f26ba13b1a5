#pragma once

#include "kinequad/core/context.h"
#include "kinequad/measure/quad_crosses.h"
#include "kinequad/symmetry/symmetry_map.h"

namespace kinequad {

/// How far the edges of a quad mesh, ours or not, are from being mirrored by `symmetry`: the angle,
/// modulo 90 degrees, between the mirrored cross of the quad over a triangle's centre and the cross
/// of the quad over the image of that centre, as the area-weighted mean over the triangles, in
/// degrees. 0 for a mirrored mesh, 22.5 for one that does not care. Triangles where one of the two
/// faces is no quad or has no extent are left out; not a number where that are all.
///
/// `reference.sides` have to be of the metric that `symmetry` was made for, since the transport is
/// an angle between frames of that metric. Throws `InputError` (mesh) where the map is not of the
/// reference's triangles, and as `QuadCrosses`. docs/measures.md
double measure_symmetry_error(const StretchReference& reference, const SymmetryMap& symmetry,
                              const Context& context = {});

}  // namespace kinequad
