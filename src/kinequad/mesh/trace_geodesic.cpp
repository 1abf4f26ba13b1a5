#include "kinequad/mesh/trace_geodesic.h"

#include "kinequad/core/index.h"
#include "kinequad/mesh/leave_triangle.h"

namespace kinequad {

SurfacePoint trace_geodesic(const Topology& topology, const IntrinsicMetric& metric,
                            const SurfacePoint& start, const Vector2& direction) {
    constexpr int most_crossings = 1000;
    SurfacePoint here = start;
    Vector2 left = direction;
    for (int crossing = 0; crossing < most_crossings; ++crossing) {
        if (triangle_area(side_lengths(topology, metric, here.triangle)) <= 0) return here;
        const TriangleExit exit = leave_triangle(topology, metric, here, left);
        if (!(exit.share < 1)) return point_on_way(topology, metric, here, left, 1);
        SurfacePoint end = point_on_way(topology, metric, here, left, exit.share);
        if (topology.twin[at(exit.half_edge)] < 0) return end;
        here = point_across(topology, end, exit.half_edge);
        const double turn = frame_rotation(topology, metric, exit.half_edge);
        left = Eigen::Rotation2Dd(turn) * ((1 - exit.share) * left);
    }
    return here;
}

}  // namespace kinequad
