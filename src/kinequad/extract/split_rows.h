#pragma once

#include <functional>
#include <vector>

#include "kinequad/extract/quad_mesh.h"

namespace kinequad {

/// Splits rows of quads lengthwise until no edge inside a quad mesh of one side joins two vertices
/// of the stationary curve: with its mirror image there would be two edges between the same two
/// vertices. A row is what one comes to from an edge by crossing quads to their opposite edges; its
/// splitting adds a regular vertex on each of these, and no irregular one.
///
/// `is_on_curve` (v) tells which vertices lie on the curve; a new vertex on a boundary edge between
/// two such vertices does, too. `middle` gives the point of the surface in the middle of two or
/// four others, where `is_on_boundary` on its boundary. Vertices keep their numbers. Throws
/// `VerificationError` where splitting does not end. docs/symmetry.md
QuadMesh split_rows_across_curve(
    QuadMesh quads, std::vector<char> is_on_curve,
    const std::function<SurfacePoint(const std::vector<SurfacePoint>& points, bool is_on_boundary)>&
        middle);

}  // namespace kinequad
