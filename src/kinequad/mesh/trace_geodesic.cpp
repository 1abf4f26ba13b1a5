#include "kinequad/mesh/trace_geodesic.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace kinequad {
namespace {

/// Barycentric change of a step `direction` in a triangle laid out as `corners`.
Vector3 barycentric_change(const Eigen::Matrix<double, 2, 3>& corners, const Vector2& direction) {
    Eigen::Matrix2d edges;
    edges << corners.col(1) - corners.col(0), corners.col(2) - corners.col(0);
    const Vector2 st = edges.inverse() * direction;
    return {-st[0] - st[1], st[0], st[1]};
}

Vector3 normalised(Vector3 barycentric) {
    barycentric = barycentric.cwiseMax(0);
    return barycentric / barycentric.sum();
}

}  // namespace

SurfacePoint trace_geodesic(const Topology& topology, const IntrinsicMetric& metric,
                            const SurfacePoint& start, const Vector2& direction) {
    constexpr int most_crossings = 1000;
    SurfacePoint here = start;
    Vector2 left = direction;
    for (int crossing = 0; crossing < most_crossings; ++crossing) {
        const auto sides = side_lengths(topology, metric, here.triangle);
        if (triangle_area(sides) <= 0) return here;
        const Vector3 change = barycentric_change(lay_out_triangle(sides), left);
        // The corner whose coordinate vanishes first is opposite the edge that is crossed.
        double share = 1;
        int gone = -1;
        for (int k = 0; k < 3; ++k) {
            if (change[k] >= 0) continue;
            const double until = std::max(0.0, here.barycentric[k]) / -change[k];
            if (until < share) {
                share = until;
                gone = k;
            }
        }
        const Vector3 end = normalised(here.barycentric + share * change);
        if (gone < 0) return {here.triangle, end};
        const int h = 3 * here.triangle + (gone + 1) % 3;
        const int other = topology.twin[static_cast<std::size_t>(h)];
        if (other < 0) return {here.triangle, end};
        SurfacePoint next;
        next.triangle = other / 3;
        next.barycentric.setZero();
        next.barycentric[other % 3] = end[(gone + 2) % 3];
        next.barycentric[(other + 1) % 3] = end[(gone + 1) % 3];
        next.barycentric = normalised(next.barycentric);
        const double turn = frame_rotation(topology, metric, h);
        left = Eigen::Rotation2Dd(turn) * ((1 - share) * left);
        here = next;
    }
    return here;
}

}  // namespace kinequad
