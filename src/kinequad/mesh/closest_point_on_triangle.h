#pragma once

#include <algorithm>

#include "kinequad/core/types.h"

namespace kinequad {

/// The point of a triangle nearest to another point.
struct TrianglePoint {
    Vector3 barycentric = Vector3(1, 0, 0);  ///< non-negative, sums to one
    double squared_distance = 0;             ///< in squared units of the input
};

/// The point of triangle `a`, `b`, `c` nearest to `p`. Triangles may be flat: a sliver, a segment
/// or a point. The distance returned is that of a point of the triangle, never of one outside it.
inline TrianglePoint closest_point_on_triangle(const Vector3& p, const Vector3& a, const Vector3& b,
                                               const Vector3& c) {
    const Vector3 ab = b - a;
    const Vector3 ac = c - a;
    const Vector3 ap = p - a;
    const double bb = ab.squaredNorm();
    const double cc = ac.squaredNorm();
    const double bc = ab.dot(ac);
    const double pb = ap.dot(ab);
    const double pc = ap.dot(ac);
    const double determinant = bb * cc - bc * bc;
    const double v = cc * pb - bc * pc;
    const double w = bb * pc - bc * pb;
    TrianglePoint best;
    bool has_best = false;
    if (determinant > 0 && v >= 0 && w >= 0 && v + w <= determinant) {
        const double beta = v / determinant;
        const double gamma = w / determinant;
        best.barycentric = Vector3(std::max(0.0, 1 - beta - gamma), beta, gamma);
        best.squared_distance = (ap - beta * ab - gamma * ac).squaredNorm();
        has_best = true;
        // In a sliver the determinant is mostly rounding: there the sides are asked as well.
        if (determinant > 1e-10 * bb * cc) return best;
    }
    const auto try_side = [&](const Vector3& from_origin, const Vector3& side, double length2,
                              int start, int end) {
        const double along = length2 > 0 ? from_origin.dot(side) / length2 : 0.0;
        const double t = std::clamp(along, 0.0, 1.0);
        const double distance2 = (from_origin - t * side).squaredNorm();
        if (has_best && distance2 >= best.squared_distance) return;
        has_best = true;
        best.squared_distance = distance2;
        best.barycentric.setZero();
        best.barycentric[start] = 1 - t;
        best.barycentric[end] = t;
    };
    try_side(ap, ab, bb, 0, 1);
    try_side(ap, ac, cc, 0, 2);
    const Vector3 side = c - b;
    try_side(p - b, side, side.squaredNorm(), 1, 2);
    return best;
}

}  // namespace kinequad
