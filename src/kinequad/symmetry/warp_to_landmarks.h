#pragma once

#include "kinequad/core/context.h"
#include "kinequad/symmetry/anti_involution.h"

namespace kinequad {

/// Moves sphere points smoothly so that the landmarks come to lie exactly symmetric to the plane
/// x . axis = 0: pairs to mirrored positions, stationary ones onto the great circle. The
/// displacement is interpolated by the kernel r^1.5 and a constant. `axis` is a unit vector.
SpherePoints warp_to_landmarks(const SpherePoints& points, const SphereLandmarks& landmarks,
                               const RealVector3& axis, const Context& context);

/// Mirror image in the plane x . axis = 0.
inline RealVector3 mirrored(const RealVector3& p, const RealVector3& axis) {
    return p - 2 * p.dot(axis) * axis;
}

}  // namespace kinequad
