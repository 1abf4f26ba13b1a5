#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "kinequad/io/polygons.h"

namespace kinequad {

/// True for the extensions that `read_polygon_mesh` reads: .obj, .ply, .off, .stl in any case.
bool is_mesh_file(const std::filesystem::path& path);

/// Reads one mesh, the format chosen by the extension. Order and number of vertices and faces stay
/// as in the file (the corners of an STL are joined). Throws `InputError` (file) where it cannot be
/// read or parsed, (mesh) where it holds no valid mesh.
PolygonMesh read_polygon_mesh(const std::filesystem::path& path);

/// As `read_polygon_mesh`, for bytes at hand; `path` tells format and name.
PolygonMesh parse_polygon_mesh(std::string_view bytes, const std::filesystem::path& path);

}  // namespace kinequad
