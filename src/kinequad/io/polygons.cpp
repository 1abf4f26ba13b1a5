#include "kinequad/io/polygons.h"

#include <fmt/format.h>

#include <limits>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"

namespace kinequad {
namespace {

template <class Faces>
Polygons rows_as_polygons(const Faces& faces) {
    Polygons polygons;
    polygons.corners.assign(faces.data(), faces.data() + faces.size());
    polygons.offset.resize(static_cast<std::size_t>(faces.rows()) + 1);
    for (std::size_t f = 0; f < polygons.offset.size(); ++f) {
        polygons.offset[f] = static_cast<int>(f) * static_cast<int>(faces.cols());
    }
    return polygons;
}

}  // namespace

void Polygons::add(std::span<const int> face) {
    if (face.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()) - corners.size()) {
        throw InputError(InputFault::mesh, "the faces have more than 2147483647 corners together");
    }
    corners.insert(corners.end(), face.begin(), face.end());
    offset.push_back(static_cast<int>(corners.size()));
}

Polygons make_polygons(const Triangles& F) { return rows_as_polygons(F); }

Polygons make_polygons(const Quads& Q) { return rows_as_polygons(Q); }

bool all_faces_have(const Polygons& faces, int corners) {
    for (int f = 0; f < faces.count(); ++f) {
        if (static_cast<int>(faces[f].size()) != corners) return false;
    }
    return true;
}

Quads require_quads(const Polygons& faces, const std::string& name) {
    Quads Q(faces.count(), 4);
    for (int f = 0; f < faces.count(); ++f) {
        const std::span<const int> face = faces[f];
        if (face.size() != 4) {
            throw InputError(
                InputFault::mesh,
                fmt::format("{}: face {} has {} corners; a mesh of quads only is needed here", name,
                            f, face.size()));
        }
        for (int k = 0; k < 4; ++k) Q(f, k) = face[at(k)];
    }
    return Q;
}

}  // namespace kinequad
