#include "kinequad/mesh/edge_distances.h"

#include <functional>
#include <queue>
#include <utility>

#include "kinequad/core/index.h"

namespace kinequad {

std::vector<double> edge_distances(const Topology& topology, const IntrinsicMetric& metric,
                                   const std::vector<int>& sources, double range) {
    std::vector<double> distance(at(topology.vertex_count),
                                 std::numeric_limits<double>::infinity());
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (const int source : sources) {
        distance[at(source)] = 0;
        queue.emplace(0.0, source);
    }
    while (!queue.empty()) {
        const double here = queue.top().first;
        const int v = queue.top().second;
        queue.pop();
        if (here > distance[at(v)]) continue;
        const auto reach = [&](int w, int half_edge) {
            const double there = here + metric.edge_length[topology.edge[at(half_edge)]];
            if (there >= distance[at(w)] || there >= range) return;
            distance[at(w)] = there;
            queue.emplace(there, w);
        };
        const int start = topology.vertex_half_edge[at(v)];
        for (int h = start; h >= 0;) {
            reach(topology.target(h), h);
            // On a boundary the last edge only arrives.
            const int arriving = Topology::previous(h);
            reach(topology.origin[at(arriving)], arriving);
            h = topology.rotate_counter_clockwise(h);
            if (h == start) break;
        }
    }
    return distance;
}

}  // namespace kinequad
