#pragma once

#include <span>
#include <string>
#include <vector>

#include "kinequad/core/index.h"
#include "kinequad/core/types.h"

namespace kinequad {

/// Faces with any number of corners each, stored one behind another.
struct Polygons {
    std::vector<int> corners;       ///< 0-based vertex indices of all faces, counter-clockwise
    std::vector<int> offset = {0};  ///< face f holds corners offset[f] .. offset[f + 1] - 1

    /// Number of faces.
    int count() const { return static_cast<int>(offset.size()) - 1; }
    /// The vertex indices of face `face`.
    std::span<const int> operator[](int face) const {
        const auto first = static_cast<std::size_t>(offset[at(face)]);
        const auto last = static_cast<std::size_t>(offset[static_cast<std::size_t>(face) + 1]);
        return {corners.data() + first, last - first};
    }
    /// Appends a face. Throws `InputError` (mesh) where the corners of all faces exceed 2^31 - 1.
    void add(std::span<const int> face);

    bool operator==(const Polygons&) const = default;
};

/// A mesh as a file holds it: polygons not yet cut into triangles.
struct PolygonMesh {
    Positions V;     ///< n x 3 vertex positions, in the order of the file
    Polygons faces;  ///< every index is in [0, n)
};

/// The rows of `F` (m x 3) as polygons.
Polygons make_polygons(const Triangles& F);
/// The rows of `Q` (q x 4) as polygons.
Polygons make_polygons(const Quads& Q);

/// True where every face has exactly `corners` corners.
bool all_faces_have(const Polygons& faces, int corners);

/// The faces as rows of four (q x 4). Throws `InputError` (mesh) naming the first face that is no
/// quad of the mesh that messages call `name`.
Quads require_quads(const Polygons& faces, const std::string& name);

}  // namespace kinequad
