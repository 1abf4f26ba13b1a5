#pragma once

#include "kinequad/io/landmarks.h"
#include "kinequad/symmetry/anti_involution.h"
#include "kinequad/symmetry/surface_distances.h"

namespace kinequad {

/// Throws `InputError` (symmetry) where a landmark is not below `vertex_count`, a vertex is named
/// twice, a pair joins a vertex to itself, or the landmarks are too few for a unique symmetry: a
/// pair counts two, a stationary vertex one, and three are needed.
void check_landmarks(const Landmarks& landmarks, int vertex_count);

/// Compares distances on both sides: mirrored vertices are as far from each other as their
/// partners. `marks` are the vertices of `topology` for the vertices `names` of the input;
/// `distances` has to begin with the sorted `marks`. Returns the mean difference in percent of the
/// surface's extent. Throws `InputError` (symmetry), naming the landmark, where one disagrees with
/// the others by more than `tolerated_percent`.
double compare_landmark_distances(const SurfaceDistances& distances, const SphereLandmarks& marks,
                                  const Landmarks& names, double tolerated_percent);

}  // namespace kinequad
