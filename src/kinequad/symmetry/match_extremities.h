#pragma once

#include "kinequad/symmetry/anti_involution.h"
#include "kinequad/symmetry/surface_distances.h"

namespace kinequad {

/// Landmarks that follow from a map: ends of limbs that it sends near ends of limbs, but that
/// do not come back to themselves: beyond the last landmark of a thin limb the sphere shrinks so
/// much that the image falls on one place of the limb. `points` are sphere points after
/// `warp_to_landmarks`, symmetric to the plane x . axis = 0. Only clear matches are returned: of
/// two ends that choose each other, or one that chooses itself, far nearer than any other end.
SphereLandmarks match_extremities(const Topology& topology, const IntrinsicMetric& metric,
                                  const SurfaceDistances& distances, const SpherePoints& points,
                                  const RealVector3& axis);

}  // namespace kinequad
