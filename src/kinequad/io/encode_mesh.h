#pragma once

#include <string>

#include "kinequad/io/polygons.h"

namespace kinequad {

/// The "v" lines of an OBJ, every number in the fewest digits that give the same double back.
std::string encode_obj_positions(const Positions& V);
/// The "f" lines of an OBJ.
std::string encode_obj_faces(const Polygons& faces);

/// Header of a binary little-endian PLY with double coordinates.
std::string encode_ply_header(int vertex_count, const Polygons& faces);
/// Body of that PLY's vertices.
std::string encode_ply_positions(const Positions& V);
/// Body of that PLY's faces.
std::string encode_ply_faces(const Polygons& faces);

/// A whole OFF file.
std::string encode_off(const Positions& V, const Polygons& faces);

}  // namespace kinequad
