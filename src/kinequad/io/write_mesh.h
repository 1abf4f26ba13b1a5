#pragma once

#include <filesystem>

#include "kinequad/io/polygons.h"

namespace kinequad {

/// Writes one mesh as OBJ, PLY (binary little endian, double) or OFF, chosen by the extension; a
/// double read back is the one written. `V` are the n x 3 positions. The file appears whole or not
/// at all. Throws `InputError` (usage) for another extension, (file) where it cannot be written.
void write_mesh(const std::filesystem::path& path, const Positions& V, const Polygons& faces);

/// The same for triangles (m x 3).
void write_mesh(const std::filesystem::path& path, const Positions& V, const Triangles& F);

/// The same for quads (q x 4).
void write_mesh(const std::filesystem::path& path, const Positions& V, const Quads& Q);

}  // namespace kinequad
