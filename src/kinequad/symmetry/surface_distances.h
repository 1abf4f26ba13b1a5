#pragma once

#include <vector>

#include "kinequad/mesh/intrinsic_metric.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {

/// Distances from some vertices to all.
struct SurfaceDistances {
    std::vector<int> source;                    ///< vertices
    std::vector<std::vector<double>> distance;  ///< of every source, n
    std::vector<double> mean;                   ///< n: over the sources
    double extent = 0;                          ///< largest distance

    /// Distance of source number `i` from a point in triangle `point.triangle` of `topology`.
    double to_point(const Topology& topology, std::size_t i, const SurfacePoint& point) const;
};

/// Distances from `landmarks`, and from vertices added one by one, each the farthest from all
/// before, until there are `count` and at least `more` of these.
SurfaceDistances tabulate_distances(const Topology& topology, const IntrinsicMetric& metric,
                                    const std::vector<int>& landmarks, std::size_t count,
                                    std::size_t more);

/// Ends of limbs: the local maxima of the mean distance that are reached uphill from the sources.
std::vector<int> find_extremities(const Topology& topology, const SurfaceDistances& distances);

}  // namespace kinequad
