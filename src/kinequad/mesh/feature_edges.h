#pragma once

#include <array>
#include <string>
#include <vector>

#include "kinequad/core/types.h"
#include "kinequad/mesh/refined_mesh.h"
#include "kinequad/mesh/topology.h"

namespace kinequad {

/// Edges (ascending) across which the surface with vertex positions `V` (n x 3) turns by more than
/// `degrees`; boundary edges and edges beside a triangle without area are none.
std::vector<int> find_feature_edges(const Topology& topology, const Positions& V, double degrees);

/// The edges (ascending) between pairs of vertices; `name` is what messages call the pairs. Throws
/// `InputError` (usage) where the mesh has no such edge.
std::vector<int> edges_between(const Topology& topology,
                               const std::vector<std::array<int, 2>>& pairs,
                               const std::string& name);

/// The edges (ascending) of the refinement `fine`, with triangles `topology`, that lie on `edges`
/// of the mesh it refines, whose triangles are `coarse`.
std::vector<int> edges_along(const Topology& topology, const RefinedMesh& fine,
                             const Topology& coarse, const std::vector<int>& edges);

}  // namespace kinequad
