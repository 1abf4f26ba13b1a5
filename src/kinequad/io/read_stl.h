#pragma once

#include <string>
#include <string_view>

#include "kinequad/io/polygons.h"

namespace kinequad {

/// Reads an STL file, ascii or binary. Corners at exactly the same position become one vertex,
/// numbered in the order of their first appearance. `name` is what messages call the file. Throws
/// `InputError` (file) where the text cannot be read or the count of triangles does not fit the
/// bytes, (mesh) where a coordinate is not finite or there is no triangle.
PolygonMesh parse_stl(std::string_view bytes, const std::string& name);

}  // namespace kinequad
