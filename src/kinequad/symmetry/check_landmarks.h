#pragma once

#include "kinequad/io/landmarks.h"

namespace kinequad {

/// Throws `InputError` (symmetry) where a landmark is not below `vertex_count`, a vertex is named
/// twice, a pair joins a vertex to itself, or the landmarks are too few for a unique symmetry: a
/// pair counts two, a stationary vertex one, and three are needed.
void check_landmarks(const Landmarks& landmarks, int vertex_count);

}  // namespace kinequad
