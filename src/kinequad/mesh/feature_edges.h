#pragma once

#include <vector>

#include "kinequad/core/types.h"
#include "kinequad/mesh/topology.h"

namespace kinequad {

/// Edges (ascending) across which the surface with vertex positions `V` (n x 3) turns by more than
/// `degrees`; boundary edges and edges beside a triangle without area are none.
std::vector<int> find_feature_edges(const Topology& topology, const Positions& V, double degrees);

}  // namespace kinequad
