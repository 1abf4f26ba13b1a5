#pragma once

#include "kinequad/core/context.h"
#include "kinequad/gridmap/charted_mesh.h"
#include "kinequad/gridmap/grid_map.h"
#include "kinequad/gridmap/quantize.h"

namespace kinequad {

/// Computes the integer-grid map of a connected charted mesh with about as many quads as `wanted`.
/// Where none is found with as many, it is sought with more. Throws `GridMapError` where that does
/// not help either; `Cancelled`. docs/gridmap.md
GridMap map_component(ChartedMesh mesh, const WantedQuads& wanted, const Context& context);

}  // namespace kinequad
