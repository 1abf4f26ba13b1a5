#pragma once

#include "kinequad/mesh/intrinsic_metric.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {

/// Where a straight way meets the border of a triangle.
struct TriangleExit {
    double share = 0;    ///< of the way that leads there; more than 1 where it ends inside
    int half_edge = -1;  ///< that is crossed; -1 where the way has no direction
};

/// Where the way `direction`, a vector in the frame of the triangle of `start`, leaves it. The
/// triangle must have area.
TriangleExit leave_triangle(const Topology& topology, const IntrinsicMetric& metric,
                            const SurfacePoint& start, const Vector2& direction);

/// The point at a share of the way in the triangle of `start`, clamped to it.
SurfacePoint point_on_way(const Topology& topology, const IntrinsicMetric& metric,
                          const SurfacePoint& start, const Vector2& direction, double share);

/// A point of half-edge `h`, given in its triangle, in the triangle across; `h` must be inside.
SurfacePoint point_across(const Topology& topology, const SurfacePoint& point, int h);

}  // namespace kinequad
