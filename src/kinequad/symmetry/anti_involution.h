#pragma once

#include <array>
#include <vector>

#include "kinequad/symmetry/sphere_points.h"

namespace kinequad {

/// Landmarks as rows of an array of sphere points.
struct SphereLandmarks {
    std::vector<std::array<int, 2>> pairs;
    std::vector<int> stationary;
};

/// An anti-Moebius involution of the unit sphere with a circle of fixed points: the reflection in
/// the space-like unit vector (s, n0) of Minkowski space. The circle is x . s = n0.
struct AntiInvolution {
    Vector3 s = Vector3::UnitX();
    double n0 = 0;                         ///< |s|^2 - n0^2 = 1
    double rms = 0;                        ///< of the landmarks' chordal distances to their images
    std::vector<double> pair_error;        ///< chordal, of every pair
    std::vector<double> stationary_error;  ///< chordal, of every stationary landmark
    /// Second smallest over largest eigenvalue of the equations at unit length: 0 where more than
    /// one reflection meets them.
    double definiteness = 0;
    bool is_reflection = false;  ///< false where the best fit has no circle of fixed points

    RealVector3 apply(const RealVector3& p) const;
};

/// The anti-involution that sends the pairs' points to each other and keeps the stationary ones, in
/// the least-squares sense over all reflections; the order in a pair does not matter.
/// docs/symmetry.md
AntiInvolution fit_anti_involution(const SpherePoints& points, const SphereLandmarks& landmarks);

/// Moves the points so that the circle of fixed points becomes the great circle x . direction = 0,
/// and returns that unit vector.
RealVector3 move_to_great_circle(SpherePoints& points, const AntiInvolution& reflection);

}  // namespace kinequad
