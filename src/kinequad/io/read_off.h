#pragma once

#include <string>
#include <string_view>

#include "kinequad/io/polygons.h"

namespace kinequad {

/// Reads the text of an OFF file (also COFF, NOFF, CNOFF, STOFF): colours, normals and texture
/// coordinates behind a position or a face are passed over. `name` is what messages call the file.
/// Throws `InputError` (file) where it is no ASCII OFF, a number cannot be read, or the counts of
/// its header do not fit the text, (mesh) where a coordinate is not finite, an index names no
/// vertex, or there are no vertices or no faces.
PolygonMesh parse_off(std::string_view text, const std::string& name);

}  // namespace kinequad
