#pragma once

#include "kinequad/extract/quad_mesh.h"

namespace kinequad {

/// Positions (v x 3) of the vertices of a quad mesh in the frame of the input whose vertex
/// positions are `V` (n x 3) with triangles `F` (m x 3). One sparse product with three entries a
/// row.
Positions quad_positions(const QuadMesh& quads, const Positions& V, const Triangles& F);

}  // namespace kinequad
