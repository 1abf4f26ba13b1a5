#pragma once

#include "kinequad/mesh/intrinsic_metric.h"
#include "kinequad/symmetry/symmetry_map.h"

namespace kinequad {

/// The stationary curve of a map, and the heights that it follows from.
struct StationaryCurve {
    std::vector<std::vector<SurfacePoint>> polylines;  ///< `SymmetryMap::stationary`
    std::vector<StationaryDirection> directions;       ///< `SymmetryMap::stationary_direction`
    Eigen::VectorXd height;                            ///< n: without sign changes off the curve
    int dropped_loops = 0;                             ///< small loops that are none of the curve
};

/// Traces the zero set of `height` (n, per vertex), linear along edges, with the positive side on
/// its left. Loops shorter than `shortest_share` of the longest of their connected part are noise:
/// they are dropped, and the heights inside take the sign around them. Triangles from
/// `triangle_count` on fill holes: the polylines leave them out.
StationaryCurve trace_stationary_curve(const Topology& topology, const IntrinsicMetric& metric,
                                       const Eigen::VectorXd& height, int triangle_count,
                                       double shortest_share);

}  // namespace kinequad
