#pragma once

#include <vector>

#include "kinequad/gridmap/charted_mesh.h"
#include "kinequad/gridmap/grid_map.h"

namespace kinequad {

/// One connected part of a charted mesh.
struct MapComponent {
    ChartedMesh mesh;
    std::vector<int> vertex;  ///< of every vertex of the part, the one of the whole
    double area = 0;          ///< in cells
};

/// The connected parts of `mesh`, in the order of their lowest triangle. Vertices without triangles
/// belong to none.
std::vector<MapComponent> split_components(const ChartedMesh& mesh);

/// Puts the maps of all parts, in the order of `components`, together again. Vertices of the whole
/// (`vertex_count`) keep their numbers, those that refinement added come after them.
GridMap join_maps(const std::vector<MapComponent>& components, const std::vector<GridMap>& maps,
                  int vertex_count);

}  // namespace kinequad
