#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "kinequad/core/error.h"
#include "kinequad/io/read_polygon_mesh.h"
#include "kinequad/io/triangulate_polygons.h"

namespace kinequad::fuzz {

/// Reads arbitrary bytes as a mesh of the format that `path` tells; what is accepted has to be a
/// mesh.
inline int read_as_mesh(const std::uint8_t* data, std::size_t size, const std::string& path) {
    try {
        const std::string_view bytes(reinterpret_cast<const char*>(data), size);
        const PolygonMesh mesh = parse_polygon_mesh(bytes, path);
        if (!mesh.V.allFinite() || mesh.V.rows() == 0 || mesh.faces.count() == 0) std::abort();
        for (const int vertex : mesh.faces.corners) {
            if (vertex < 0 || vertex >= mesh.V.rows()) std::abort();
        }
        triangulate_polygons(mesh.V, mesh.faces);
    } catch (const InputError&) {
    }
    return 0;
}

}  // namespace kinequad::fuzz
