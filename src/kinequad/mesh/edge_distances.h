#pragma once

#include <limits>
#include <vector>

#include "kinequad/mesh/intrinsic_metric.h"

namespace kinequad {

/// Lengths of shortest edge paths from the nearest of the vertices `sources` to all vertices (n),
/// in units of the metric; infinite where none leads, or none shorter than `range`.
std::vector<double> edge_distances(const Topology& topology, const IntrinsicMetric& metric,
                                   const std::vector<int>& sources,
                                   double range = std::numeric_limits<double>::infinity());

}  // namespace kinequad
