#pragma once

#include "kinequad/gridmap/map_variables.h"

namespace kinequad {

/// Splits edges of a mesh that carries a map at their middle. The new vertices get columns of their
/// own and the values in between, so that the map stays the same; `half_edges` names every edge
/// once. Returns the values of all columns; `mesh` and `variables` are refined in place.
/// `MapVariables::integer_part` is dropped: it belongs to the mesh that integers were chosen on.
Eigen::VectorXd refine_map(ChartedMesh& mesh, MapVariables& variables, Eigen::VectorXd x,
                           const std::vector<int>& half_edges);

}  // namespace kinequad
