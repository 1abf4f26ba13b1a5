#include "kinequad/io/write_mesh.h"

#include <fmt/format.h>

#include "kinequad/core/error.h"
#include "kinequad/io/encode_mesh.h"
#include "kinequad/io/files.h"

namespace kinequad {

void write_mesh(const std::filesystem::path& path, const Positions& V, const Polygons& faces) {
    const std::string extension = extension_of(path);
    if (extension == ".obj") {
        write_file_atomically(path, encode_obj_positions(V) + encode_obj_faces(faces));
    } else if (extension == ".ply") {
        write_file_atomically(path, encode_ply_header(static_cast<int>(V.rows()), faces) +
                                        encode_ply_positions(V) + encode_ply_faces(faces));
    } else if (extension == ".off") {
        write_file_atomically(path, encode_off(V, faces));
    } else {
        throw InputError(
            InputFault::usage,
            fmt::format("{}: a mesh is written as .obj, .ply or .off; name one of these",
                        path.string()));
    }
}

void write_mesh(const std::filesystem::path& path, const Positions& V, const Triangles& F) {
    write_mesh(path, V, make_polygons(F));
}

void write_mesh(const std::filesystem::path& path, const Positions& V, const Quads& Q) {
    write_mesh(path, V, make_polygons(Q));
}

}  // namespace kinequad
