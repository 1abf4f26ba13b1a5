#pragma once

#include <vector>

#include "kinequad/core/types.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {

/// One quad connectivity for all frames. A vertex is a point of the input surface, so that a frame
/// of the quad mesh is one sparse product with a frame of the input.
struct QuadMesh {
    Quads Q;  ///< q x 4 vertex indices, counter-clockwise seen from outside
    std::vector<SurfacePoint> vertex;  ///< one a vertex, on the input mesh
    std::vector<int> mirror;           ///< mirror vertex of every vertex; empty without symmetry
};

}  // namespace kinequad
