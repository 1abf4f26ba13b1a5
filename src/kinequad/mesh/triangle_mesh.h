#pragma once

#include "kinequad/core/types.h"

namespace kinequad {

/// An indexed triangle mesh in space. One frame of an animation is such a mesh; all frames share
/// `F`.
struct TriangleMesh {
    Positions V;  ///< n x 3 vertex positions, in the units of the input
    Triangles F;  ///< m x 3 vertex indices
};

/// A point on a triangle mesh: the triangle that holds it and its barycentric coordinates there,
/// non-negative and summing to one. The same point in every frame.
struct SurfacePoint {
    int triangle = -1;
    Vector3 barycentric = Vector3(1, 0, 0);

    bool operator==(const SurfacePoint& other) const {
        return triangle == other.triangle && barycentric == other.barycentric;
    }
};

/// Centre of the triangle with corners `a`, `b` and `c`.
inline Vector3 triangle_centre(const Vector3& a, const Vector3& b, const Vector3& c) {
    return (a + b + c) / 3;
}

/// Normal of the triangle with corners `a`, `b` and `c`, on the side that sees them
/// counter-clockwise; its length is twice the area.
inline Vector3 triangle_area_vector(const Vector3& a, const Vector3& b, const Vector3& c) {
    return (b - a).cross(c - a);
}

/// The same of triangle `t` of `F` (m x 3) in the frame whose vertex positions are `V` (n x 3).
inline Vector3 triangle_centre(const Positions& V, const Triangles& F, Eigen::Index t) {
    return triangle_centre(V.row(F(t, 0)), V.row(F(t, 1)), V.row(F(t, 2)));
}
inline Vector3 triangle_area_vector(const Positions& V, const Triangles& F, Eigen::Index t) {
    return triangle_area_vector(V.row(F(t, 0)), V.row(F(t, 1)), V.row(F(t, 2)));
}

/// Length of the diagonal of the axis-aligned bounding box of the rows of `V`; 0 where there is
/// none.
double bounding_box_diagonal(const Positions& V);

/// Position of a surface point in the frame whose vertex positions are `V` (n x 3).
Vector3 position_of(const SurfacePoint& point, const Positions& V, const Triangles& F);

}  // namespace kinequad
