#include "kinequad/mesh/boundary_walk.h"

#include <algorithm>

namespace kinequad {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

SurfacePoint point_on(int half_edge, double share) {
    SurfacePoint point{half_edge / 3, Vector3::Zero()};
    point.barycentric[half_edge % 3] = 1 - share;
    point.barycentric[Topology::next(half_edge) % 3] = share;
    return point;
}

}  // namespace

BoundaryWalk::BoundaryWalk(const Topology& topology, const IntrinsicMetric& metric,
                           const std::vector<int>& edges)
    : topology_(topology),
      metric_(metric),
      next_(topology.origin.size(), -1),
      previous_(topology.origin.size(), -1),
      is_walked_(topology.origin.size(), 0) {
    for (const int e : edges) is_walked_[at(topology.edge_half_edge[at(e)])] = 1;
    for (const int e : edges) {
        const int h = topology.edge_half_edge[at(e)];
        const int after = topology.vertex_half_edge[at(topology.target(h))];
        if (!is_walked_[at(after)]) continue;
        next_[at(h)] = after;
        previous_[at(after)] = h;
    }
}

int BoundaryWalk::half_edge_of(const SurfacePoint& point) const {
    for (int k = 0; k < 3; ++k) {
        if (point.barycentric[k] == 1) {
            const int v = topology_.origin[at(3 * point.triangle + k)];
            const int h = topology_.vertex_half_edge[at(v)];
            return is_walked_[at(h)] && previous_[at(h)] >= 0 ? h : -1;
        }
    }
    for (int k = 0; k < 3; ++k) {
        const int h = 3 * point.triangle + (k + 1) % 3;
        if (point.barycentric[k] == 0 && is_walked_[at(h)]) return h;
    }
    return -1;
}

Vector2 BoundaryWalk::direction(int half_edge) const {
    const auto corners = lay_out_triangle(side_lengths(topology_, metric_, half_edge / 3));
    return (corners.col(Topology::next(half_edge) % 3) - corners.col(half_edge % 3)).normalized();
}

SurfacePoint BoundaryWalk::walk(const SurfacePoint& start, int half_edge, double length) const {
    int h = half_edge;
    const auto size = [&] { return metric_.edge_length[topology_.edge[at(h)]]; };
    double position = start.triangle == h / 3
                          ? start.barycentric[Topology::next(h) % 3] * size() + length
                          : length;
    while (position > size() && next_[at(h)] >= 0) {
        position -= size();
        h = next_[at(h)];
    }
    while (position < 0 && previous_[at(h)] >= 0) {
        h = previous_[at(h)];
        position += size();
    }
    const double whole = size();
    // A point at an end of an edge would belong to two; it keeps a little away.
    const double share = whole > 0 ? std::min(std::max(position / whole, 1e-6), 1 - 1e-6) : 0.5;
    return point_on(h, share);
}

}  // namespace kinequad
