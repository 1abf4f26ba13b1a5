#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "kinequad/mesh/intrinsic_metric.h"

namespace kinequad {

/// The inverse of a rest triangle's edge matrix, `[[a, b], [0, d]]`; all 0 where it is collapsed.
/// Internal to this stage.
struct RestTriangle {
    double a = 0;
    double b = 0;
    double d = 0;
};

/// Rest triangles of a metric (m).
std::vector<RestTriangle> rest_triangles(const Topology& topology, const IntrinsicMetric& metric);

/// The symmetric strain `J^T J = [[A, B], [B, D]]` of a triangle, as its trace, its deviator
/// `(A - D) + 2 i B` (the direction of the larger stretch at half the argument) and the root of its
/// determinant.
struct TriangleStrain {
    double trace = 0;
    double x = 0;
    double y = 0;
    double area_ratio = 0;

    /// False where the triangle is collapsed, here or at rest.
    bool valid() const { return area_ratio > 1e-7 * trace; }
    /// Larger over smaller stretch, minus one.
    double stretch() const {
        const double larger_square = 0.5 * (trace + std::sqrt(x * x + y * y));
        return std::max(0.0, larger_square / area_ratio - 1);
    }
};

/// Strain of the triangle with corners `p`, `q`, `r` (three coordinates each) against `rest`. Edge
/// lengths in space stand for the edge matrix: `J^T J = P0^-T (P^T P) P0^-1`.
inline TriangleStrain strain_of(const RestTriangle& rest, const double* p, const double* q,
                                const double* r) {
    const double ux = q[0] - p[0], uy = q[1] - p[1], uz = q[2] - p[2];
    const double vx = r[0] - p[0], vy = r[1] - p[1], vz = r[2] - p[2];
    const double uu = ux * ux + uy * uy + uz * uz;
    const double uv = ux * vx + uy * vy + uz * vz;
    const double vv = vx * vx + vy * vy + vz * vz;
    const double A = rest.a * rest.a * uu;
    const double B = rest.a * (rest.b * uu + rest.d * uv);
    const double D = rest.b * (rest.b * uu + 2 * rest.d * uv) + rest.d * rest.d * vv;
    const double gram = uu * vv - uv * uv;
    return {A + D, A - D, 2 * B, std::abs(rest.a * rest.d) * std::sqrt(std::max(0.0, gram))};
}

}  // namespace kinequad
