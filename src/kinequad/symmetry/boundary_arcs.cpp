#include "kinequad/symmetry/boundary_arcs.h"

#include <algorithm>
#include <cmath>

#include "kinequad/core/index.h"

namespace kinequad {

BoundaryArcs::BoundaryArcs(const Topology& topology, const IntrinsicMetric& metric)
    : topology_(topology), start_(topology.origin.size()), length_(topology.origin.size(), 0) {
    for (const std::vector<int>& half_edges : boundary_loops(topology)) {
        std::vector<Edge> loop;
        double position = 0;
        for (const int h : half_edges) {
            const double length = metric.edge_length[topology.edge[at(h)]];
            start_[at(h)] = {static_cast<int>(loops_.size()), position};
            length_[at(h)] = length;
            loop.push_back({h, position, length});
            position += length;
        }
        loops_.push_back(std::move(loop));
    }
}

double BoundaryArcs::length(int loop) const {
    const Edge& last = loops_[at(loop)].back();
    return last.start + last.length;
}

BoundaryPlace BoundaryArcs::locate(const SurfacePoint& point) const {
    int corners = 0;
    int corner = 0;
    for (int k = 0; k < 3; ++k) {
        if (!(point.barycentric[k] > 0)) continue;
        ++corners;
        corner = k;
    }
    if (corners == 1) {
        const int v = topology_.origin[at(3 * point.triangle + corner)];
        return start_[at(topology_.vertex_half_edge[at(v)])];
    }
    if (corners != 2) return {};
    for (int k = 0; k < 3; ++k) {
        if (point.barycentric[k] > 0) continue;
        const int h = 3 * point.triangle + (k + 1) % 3;
        const BoundaryPlace start = start_[at(h)];
        if (start.loop < 0) return {};
        return {start.loop, start.position + point.barycentric[(k + 2) % 3] * length_[at(h)]};
    }
    return {};
}

SurfacePoint BoundaryArcs::point_at(const BoundaryPlace& place) const {
    const std::vector<Edge>& loop = loops_[at(place.loop)];
    const double whole = length(place.loop);
    double position = std::fmod(place.position, whole);
    if (position < 0) position += whole;
    const auto after = std::upper_bound(loop.begin(), loop.end(), position,
                                        [](double x, const Edge& edge) { return x < edge.start; });
    const Edge& edge = after == loop.begin() ? loop.front() : *std::prev(after);
    const double share =
        edge.length > 0 ? std::clamp((position - edge.start) / edge.length, 0.0, 1.0) : 0.0;
    SurfacePoint point{edge.half_edge / 3, Vector3::Zero()};
    point.barycentric[edge.half_edge % 3] = 1 - share;
    point.barycentric[Topology::next(edge.half_edge) % 3] = share;
    return point;
}

}  // namespace kinequad
