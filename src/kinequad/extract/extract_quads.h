#pragma once

#include "kinequad/core/context.h"
#include "kinequad/extract/quad_mesh.h"
#include "kinequad/gridmap/grid_map.h"

namespace kinequad {

/// Reads off the quad mesh that the integer lines of a grid map draw on the surface.
///
/// The vertices are the points with integer coordinates, kept as points of the *input* mesh of the
/// map (not of its refinement), numbered in the order of the map's triangles. All decisions are
/// exact, so that a valid map gives all quads, manifold, consistently oriented and of the surface's
/// topology. Throws `GridMapError` naming the element where the map is not valid,
/// `VerificationError` where the integer lines do not close up to quads all the same, and
/// `Cancelled`. docs/extraction.md, [Ebke 2013].
QuadMesh extract_quads(const GridMap& map, const Context& context);

}  // namespace kinequad
