#pragma once

#include "kinequad/core/context.h"
#include "kinequad/io/landmarks.h"
#include "kinequad/symmetry/anti_involution.h"
#include "kinequad/symmetry/closed_surface.h"

namespace kinequad {

/// Fits the symmetry without each landmark in turn, and asks where it sends that one: the mean
/// distance from where it should go, in percent of the surface's extent, is what the map is wrong
/// by far from landmarks. `marks` are the vertices of `surface` for the vertices `names` of the
/// input. Throws `InputError` (symmetry), naming the landmark, where one disagrees with the others.
/// 0 where there are too few landmarks to leave one out.
double hold_out_landmarks(const ClosedSurface& surface, const SpherePoints& points,
                          const SphereLandmarks& marks, const Landmarks& names,
                          const Context& context);

}  // namespace kinequad
