#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "kinequad/io/polygons.h"

namespace kinequad {

/// Reads the text of a Wavefront OBJ file. Positions and faces keep their order; texture
/// coordinates, normals, colours, groups, materials, lines and points are passed over; negative
/// indices, joined lines and any line ends are understood. `name` is what messages call the file.
/// Throws `InputError` (file) where a number or face cannot be read, (mesh) where a coordinate is
/// not finite, an index names no vertex, or there are no vertices or no faces.
PolygonMesh parse_obj(std::string_view text, const std::string& name);

/// What is needed to read a further frame of an OBJ sequence without parsing its faces again.
struct ObjPattern {
    int vertex_count = 0;
    std::string tail;  ///< the text behind the last vertex, with all faces; empty where a face
                       ///< comes before it
};

/// The pattern of a text that `parse_obj` accepts.
ObjPattern find_obj_pattern(std::string_view text, const std::string& name);

/// The positions (n x 3) of an OBJ text whose vertices are followed by exactly the pattern's tail,
/// and whose faces are therefore those of the pattern. Nothing where that does not hold:
/// `parse_obj` then has to decide. Throws as `parse_obj`.
std::optional<Positions> parse_obj_positions(std::string_view text, const std::string& name,
                                             const ObjPattern& pattern);

}  // namespace kinequad
