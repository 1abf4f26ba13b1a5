#pragma once

#include <cstddef>
#include <string>

#include "kinequad/core/context.h"
#include "kinequad/io/landmarks.h"
#include "kinequad/mesh/topology.h"
#include "kinequad/symmetry/anti_involution.h"
#include "kinequad/symmetry/surface_distances.h"

namespace kinequad {

/// What messages call landmark `i`, pairs first: "pairs[3] (12, 40)" or "stationary[0] (7)".
std::string describe_landmark(const Landmarks& landmarks, std::size_t i);

/// Throws `InputError` (symmetry) where a landmark is no vertex of `topology` or in none of its
/// triangles, a vertex is named twice, a pair joins a vertex to itself, or the landmarks are too
/// few for a unique symmetry: a pair counts two, a stationary vertex one, and three are needed.
void check_landmarks(const Landmarks& landmarks, const Topology& topology);

/// Compares distances on both sides: mirrored vertices are as far from each other as their
/// partners. `marks` are the vertices of the closed surface for the vertices `names` of the input;
/// `distances` has to begin with the sorted `marks`. Returns the mean difference in percent of the
/// surface's extent. Throws `InputError` (symmetry), naming the landmark, where one disagrees with
/// the others by more than `tolerated_percent`, and those that may be it where more than one do.
double compare_landmark_distances(const SurfaceDistances& distances, const SphereLandmarks& marks,
                                  const Landmarks& names, double tolerated_percent);

/// Warns of pairs that name left and right the other way around than all but a few: the map is the
/// same, but what else the user names by these pairs may not be. `height` (n) is positive on one
/// side of the map's stationary curve and negative on the other.
void warn_of_turned_pairs(const Landmarks& landmarks, const Eigen::VectorXd& height,
                          const Context& context);

}  // namespace kinequad
