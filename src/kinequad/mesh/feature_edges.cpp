#include "kinequad/mesh/feature_edges.h"

#include <cmath>
#include <numbers>

namespace kinequad {

std::vector<int> find_feature_edges(const Topology& topology, const Positions& V, double degrees) {
    const auto normal_of = [&](int t) -> Vector3 {
        const auto corner = [&](int k) -> Vector3 {
            return V
                .row(topology.origin[3 * static_cast<std::size_t>(t) + static_cast<std::size_t>(k)])
                .transpose();
        };
        return (corner(1) - corner(0)).cross(corner(2) - corner(0));
    };
    const double limit = degrees * std::numbers::pi / 180;
    std::vector<int> features;
    for (int e = 0; e < topology.edge_count; ++e) {
        if (topology.is_boundary_edge(e)) continue;
        const int h = topology.edge_half_edge[static_cast<std::size_t>(e)];
        const Vector3 left = normal_of(h / 3);
        const Vector3 right = normal_of(topology.twin[static_cast<std::size_t>(h)] / 3);
        if (left.squaredNorm() == 0 || right.squaredNorm() == 0) continue;
        if (std::atan2(left.cross(right).norm(), left.dot(right)) > limit) features.push_back(e);
    }
    return features;
}

}  // namespace kinequad
