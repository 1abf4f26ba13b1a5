#include "kinequad/symmetry/surface_distances.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinequad/core/index.h"
#include "kinequad/mesh/edge_distances.h"

namespace kinequad {
namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

}  // namespace

double SurfaceDistances::to_point(const Topology& topology, std::size_t i,
                                  const SurfacePoint& point) const {
    double result = 0;
    for (int k = 0; k < 3; ++k) {
        const int v = topology.origin[at(3 * point.triangle + k)];
        result += point.barycentric[k] * distance[i][at(v)];
    }
    return result;
}

SurfaceDistances tabulate_distances(const Topology& topology, const IntrinsicMetric& metric,
                                    const std::vector<int>& landmarks, std::size_t count,
                                    std::size_t more) {
    SurfaceDistances table;
    table.source = landmarks;
    if (table.source.empty()) table.source.push_back(topology.origin.front());
    std::vector<double> nearest(at(topology.vertex_count), endless);
    table.mean.assign(at(topology.vertex_count), 0.0);
    const std::size_t total = std::max(count, table.source.size() + more);
    for (std::size_t i = 0; i < total; ++i) {
        if (i == table.source.size()) {
            int farthest = table.source.front();
            for (int v = 0; v < topology.vertex_count; ++v) {
                if (std::isfinite(nearest[at(v)]) && nearest[at(v)] > nearest[at(farthest)]) {
                    farthest = v;
                }
            }
            table.source.push_back(farthest);
        }
        table.distance.push_back(edge_distances(topology, metric, {table.source[i]}));
        for (std::size_t v = 0; v < nearest.size(); ++v) {
            const double d = table.distance.back()[v];
            nearest[v] = std::min(nearest[v], d);
            table.mean[v] += d / static_cast<double>(total);
            if (std::isfinite(d)) table.extent = std::max(table.extent, d);
        }
    }
    return table;
}

std::vector<int> find_extremities(const Topology& topology, const SurfaceDistances& distances) {
    std::vector<int> result;
    for (int v : distances.source) {
        // Two rings see past the bumps of single vertices.
        for (bool is_rising = true; is_rising;) {
            int highest = v;
            for (const int h : outgoing_half_edges(topology, v)) {
                for (const int g : outgoing_half_edges(topology, topology.target(h))) {
                    const int w = topology.target(g);
                    if (distances.mean[at(w)] > distances.mean[at(highest)]) highest = w;
                }
            }
            is_rising = highest != v;
            v = highest;
        }
        if (std::find(result.begin(), result.end(), v) == result.end()) result.push_back(v);
    }
    std::sort(result.begin(), result.end());
    return result;
}

}  // namespace kinequad
