#pragma once

#include "kinequad/mesh/topology.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {

/// For every vertex (n) the lowest one that it is joined with: boundary vertices at one and the
/// same place, and boundary loops of different components that lie next to each other, have equally
/// many edges and about the same shape, as the parts of one character have where they were modelled
/// apart. All of them themselves where nothing fits, or where joining would give no manifold.
std::vector<int> weld_seams(const TriangleMesh& mesh, const Topology& topology);

}  // namespace kinequad
