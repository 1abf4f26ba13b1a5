#include "kinequad/mesh/widen_flat_triangles.h"

#include <algorithm>

namespace kinequad {

IntrinsicMetric widen_flat_triangles(const Topology& topology, IntrinsicMetric metric) {
    if (topology.edge_count == 0) return metric;
    const double wanted = 1e-6 * metric.edge_length.mean();
    double lack = 0;
    for (int t = 0; t < topology.triangle_count; ++t) {
        const auto [a, b, c] = side_lengths(topology, metric, t);
        const double longest = std::max({a, b, c});
        lack = std::max(lack, wanted - (a + b + c - 2 * longest));
    }
    metric.edge_length.array() += lack;
    return metric;
}

}  // namespace kinequad
