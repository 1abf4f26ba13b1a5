#pragma once

#include "kinequad/core/types.h"
#include "kinequad/io/polygons.h"

namespace kinequad {

/// Cuts polygons into triangles, in the order of the faces and with their orientation; a face of k
/// corners gives k - 2 triangles. A quad is cut along its shorter diagonal unless that makes a
/// triangle without area, or one turned over, and the other diagonal does not; longer faces lose
/// the ear with the shortest diagonal until a quad is left (beyond 128 corners: a fan from the
/// first corner). `V` are the n x 3 positions of the one frame that decides. A triangle is passed
/// on as it is.
Triangles triangulate_polygons(const Positions& V, const Polygons& faces);

}  // namespace kinequad
