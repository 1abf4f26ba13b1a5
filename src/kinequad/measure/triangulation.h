#pragma once

#include <vector>

#include "kinequad/core/index.h"
#include "kinequad/io/polygons.h"

namespace kinequad {

/// Number of corners of a face.
inline int degree_of(const Polygons& faces, int face) {
    return static_cast<int>(faces[face].size());
}
/// Vertex of corner `k` of a face, 0 <= k < its degree.
inline int vertex_of(const Polygons& faces, int face, int k) { return faces[face][at(k)]; }

/// Throws `InputError` (mesh), naming the face, where a face has fewer than three corners or names
/// a vertex that is not among the `vertex_count`, and where there is no face.
void check_polygons(const Polygons& faces, int vertex_count);

/// Polygons cut into triangles: those of a face are consecutive, faces in order.
struct Triangulation {
    Triangles F;
    std::vector<int> face;  ///< the face that a triangle was cut from
};

/// The surface that distances are measured to: quads cut along the shorter diagonal in the pose `V`
/// (n x 3), along corners 0-2 where both are equal, and other faces into a fan around their first
/// corner. Unlike `triangulate_polygons` it follows every frame and mends nothing.
Triangulation triangulate_for_measuring(const Polygons& faces, const Positions& V);

}  // namespace kinequad
