#pragma once

#include "kinequad/core/types.h"
#include "kinequad/io/polygons.h"

namespace kinequad {

/// Faces as `RenderScene` wants them (m x 4, the last -1 for a triangle): triangles and quads as
/// they are, larger faces cut into a fan around their first corner. Throws `InputError` (mesh) for
/// a face with fewer than three corners.
Quads drawable_polygons(const Polygons& faces);

}  // namespace kinequad
