#include "kinequad/io/read_polygon_mesh.h"

#include <fmt/format.h>

#include "kinequad/core/error.h"
#include "kinequad/io/files.h"
#include "kinequad/io/read_obj.h"
#include "kinequad/io/read_off.h"
#include "kinequad/io/read_ply.h"
#include "kinequad/io/read_stl.h"

namespace kinequad {

bool is_mesh_file(const std::filesystem::path& path) {
    const std::string extension = extension_of(path);
    return extension == ".obj" || extension == ".ply" || extension == ".off" || extension == ".stl";
}

PolygonMesh read_polygon_mesh(const std::filesystem::path& path) {
    return parse_polygon_mesh(read_text_file(path), path);
}

PolygonMesh parse_polygon_mesh(std::string_view bytes, const std::filesystem::path& path) {
    const std::string name = path.string();
    if (!is_mesh_file(path)) {
        throw InputError(
            InputFault::file,
            fmt::format("{}: is of no format that can be read here; use OBJ, PLY, OFF or STL",
                        name));
    }
    if (bytes.empty()) throw InputError(InputFault::file, name + ": is empty; write it again");
    const std::string extension = extension_of(path);
    if (extension == ".obj") return parse_obj(bytes, name);
    if (extension == ".ply") return parse_ply(bytes, name);
    if (extension == ".off") return parse_off(bytes, name);
    return parse_stl(bytes, name);
}

}  // namespace kinequad
