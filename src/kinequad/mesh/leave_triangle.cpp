#include "kinequad/mesh/leave_triangle.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "kinequad/core/index.h"

namespace kinequad {
namespace {

/// Barycentric change by the whole way.
Vector3 barycentric_change(const Topology& topology, const IntrinsicMetric& metric, int triangle,
                           const Vector2& direction) {
    const auto corners = lay_out_triangle(side_lengths(topology, metric, triangle));
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

TriangleExit leave_triangle(const Topology& topology, const IntrinsicMetric& metric,
                            const SurfacePoint& start, const Vector2& direction) {
    const Vector3 change = barycentric_change(topology, metric, start.triangle, direction);
    TriangleExit exit{std::numeric_limits<double>::infinity(), -1};
    // The corner whose coordinate vanishes first is opposite the edge that is crossed.
    for (int k = 0; k < 3; ++k) {
        if (!(change[k] < 0)) continue;
        const double until = std::max(0.0, start.barycentric[k]) / -change[k];
        if (until >= exit.share) continue;
        exit = {until, 3 * start.triangle + (k + 1) % 3};
    }
    return exit;
}

SurfacePoint point_on_way(const Topology& topology, const IntrinsicMetric& metric,
                          const SurfacePoint& start, const Vector2& direction, double share) {
    const Vector3 change = barycentric_change(topology, metric, start.triangle, direction);
    return {start.triangle, normalised(start.barycentric + share * change)};
}

SurfacePoint point_across(const Topology& topology, const SurfacePoint& point, int h) {
    const int other = topology.twin[at(h)];
    SurfacePoint next{other / 3, Vector3::Zero()};
    next.barycentric[other % 3] = point.barycentric[Topology::next(h) % 3];
    next.barycentric[Topology::next(other) % 3] = point.barycentric[h % 3];
    next.barycentric = normalised(next.barycentric);
    return next;
}

}  // namespace kinequad
