#pragma once

#include <string>
#include <string_view>

#include "kinequad/io/polygons.h"

namespace kinequad {

/// Reads a PLY file (ascii, binary little endian, binary big endian): x, y, z of the element
/// "vertex" and the list vertex_indices (or vertex_index) of the element "face"; other properties
/// and elements are passed over. `name` is what messages call the file. Throws `InputError` (file)
/// where the header cannot be read, its counts do not fit the bytes, or a number cannot be read,
/// (mesh) where a coordinate is not finite, an index names no vertex, or there are no vertices or
/// no faces.
PolygonMesh parse_ply(std::string_view bytes, const std::string& name);

}  // namespace kinequad
