#include "kinequad/mesh/split_along_level.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "kinequad/core/index.h"

namespace kinequad {
namespace {

int sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

/// How near to a vertex the zero set crosses an edge where it is taken to pass through the vertex.
class SnapReach {
public:
    SnapReach(const Topology& topology, const IntrinsicMetric& metric, double share, SnapUnit unit)
        : metric_(metric), share_(share), unit_(unit) {
        if (unit == SnapUnit::crossed_edge) return;
        shortest_.assign(at(topology.vertex_count), std::numeric_limits<double>::infinity());
        for (int e = 0; e < topology.edge_count; ++e) {
            const int h = topology.edge_half_edge[at(e)];
            for (const int v : {topology.origin[at(h)], topology.target(h)}) {
                shortest_[at(v)] = std::min(shortest_[at(v)], metric.edge_length[e]);
            }
        }
    }

    /// As a share of edge `e`, from its end `v`.
    double share(int v, int e) const {
        const double length = metric_.edge_length[e];
        if (unit_ == SnapUnit::crossed_edge || !(length > 0)) return share_;
        return share_ * shortest_[at(v)] / length;
    }

private:
    const IntrinsicMetric& metric_;
    double share_;
    SnapUnit unit_;
    std::vector<double> shortest_;  ///< v: length of the shortest edge
};

/// Moves vertices next to the zero set onto it, one after the other.
class Snapping {
public:
    Snapping(const Topology& topology, Eigen::VectorXd height)
        : topology_(topology), height_(std::move(height)) {}

    void run(const SnapReach& reach) {
        struct Candidate {
            double share;
            int vertex;
        };
        std::vector<Candidate> candidates;
        for (int e = 0; e < topology_.edge_count; ++e) {
            const int h = topology_.edge_half_edge[at(e)];
            const int a = topology_.origin[at(h)];
            const int b = topology_.target(h);
            if (sign(height_[a]) * sign(height_[b]) >= 0) continue;
            const double along = height_[a] / (height_[a] - height_[b]);
            if (along < reach.share(a, e)) candidates.push_back({along, a});
            if (1 - along < reach.share(b, e)) candidates.push_back({1 - along, b});
        }
        std::sort(candidates.begin(), candidates.end(), [](const Candidate& x, const Candidate& y) {
            return x.share != y.share ? x.share < y.share : x.vertex < y.vertex;
        });
        for (const Candidate& candidate : candidates) {
            if (height_[candidate.vertex] != 0 && can_lie_on_level(candidate.vertex)) {
                height_[candidate.vertex] = 0;
            }
        }
    }

    const Eigen::VectorXd& height() const { return height_; }

private:
    /// Whether the zero set stays a simple curve when it passes through `v`: among the neighbours
    /// around, it has to come in and go out once, and to meet vertices of the zero set only there.
    bool can_lie_on_level(int v) const {
        const std::vector<int> fan = outgoing_half_edges(topology_, v);
        std::vector<int> around;
        around.reserve(fan.size() + 1);
        for (const int h : fan) around.push_back(sign(height_[topology_.target(h)]));
        const bool is_open = topology_.is_boundary_vertex(v);
        if (is_open) {
            const int last = topology_.origin[at(Topology::previous(fan.back()))];
            around.push_back(sign(height_[last]));
            if (around.front() == 0 || around.back() == 0) return false;
        }
        const std::size_t count = around.size();
        const std::size_t pairs = is_open ? count - 1 : count;
        int passages = 0;
        for (std::size_t i = 0; i < pairs; ++i) {
            const int here = around[i];
            const int next = around[(i + 1) % count];
            if (here == 0 && next == 0) return false;
            if (here * next < 0) ++passages;
            if (here != 0) continue;
            if (around[(i + count - 1) % count] * next >= 0) return false;
            ++passages;
        }
        return passages == (is_open ? 1 : 2);
    }

    const Topology& topology_;
    Eigen::VectorXd height_;
};

/// Cuts triangles between the points where their edges cross the zero set.
class Cutting {
public:
    Cutting(const Topology& topology, const IntrinsicMetric& metric, const Eigen::VectorXd& height,
            const SnapReach& reach)
        : topology_(topology), metric_(metric), height_(height) {
        split_.mesh.vertex_count = topology.vertex_count;
        for (int v = 0; v < topology.vertex_count; ++v) {
            split_.is_on_level.push_back(height[v] == 0 ? 1 : 0);
        }
        crossing_.assign(at(topology.edge_count), -1);
        share_.assign(at(topology.edge_count), 0);
        for (int e = 0; e < topology.edge_count; ++e) {
            const int h = topology.edge_half_edge[at(e)];
            const double a = height[topology.origin[at(h)]];
            const double b = height[topology.target(h)];
            if (sign(a) * sign(b) >= 0) continue;
            crossing_[at(e)] = split_.mesh.vertex_count++;
            share_[at(e)] = std::clamp(a / (a - b), reach.share(topology.origin[at(h)], e) / 2,
                                       1 - reach.share(topology.target(h), e) / 2);
            split_.is_on_level.push_back(1);
        }
    }

    LevelSplit run() {
        for (int t = 0; t < topology_.triangle_count; ++t) cut(t);
        const auto count = static_cast<Eigen::Index>(split_.mesh.parent.size());
        split_.mesh.F = Eigen::Map<const Triangles>(corner_.data(), count, 3);
        split_.mesh.barycentric.resize(3 * count, 3);
        for (Eigen::Index row = 0; row < 3 * count; ++row) {
            split_.mesh.barycentric.row(row) = barycentric_[at(row)].transpose();
        }
        return std::move(split_);
    }

private:
    struct Corner {
        int vertex;
        Vector3 barycentric;
    };

    Corner corner_of(int half_edge) const {
        return {topology_.origin[at(half_edge)], Vector3::Unit(half_edge % 3)};
    }
    Corner crossing_of(int half_edge) const {
        const int e = topology_.edge[at(half_edge)];
        const bool is_lower = topology_.edge_half_edge[at(e)] == half_edge;
        const double share = is_lower ? share_[at(e)] : 1 - share_[at(e)];
        Vector3 barycentric = Vector3::Zero();
        barycentric[half_edge % 3] = 1 - share;
        barycentric[Topology::next(half_edge) % 3] = share;
        return {crossing_[at(e)], barycentric};
    }
    bool is_crossed(int half_edge) const {
        return crossing_[at(topology_.edge[at(half_edge)])] >= 0;
    }

    void add(int t, int side, const Corner& a, const Corner& b, const Corner& c) {
        split_.mesh.parent.push_back(t);
        split_.side.push_back(side);
        for (const Corner* corner : {&a, &b, &c}) {
            corner_.push_back(corner->vertex);
            barycentric_.push_back(corner->barycentric);
        }
    }

    void cut(int t) {
        int crossings = 0;
        for (int h = 3 * t; h < 3 * t + 3; ++h) crossings += is_crossed(h) ? 1 : 0;
        if (crossings == 0) {
            int side = 0;
            for (int h = 3 * t; h < 3 * t + 3; ++h) {
                if (side == 0) side = sign(height_[topology_.origin[at(h)]]);
            }
            add(t, side, corner_of(3 * t), corner_of(3 * t + 1), corner_of(3 * t + 2));
            return;
        }
        // The half-edge that the corner alone on its side, or on the zero set, starts.
        int h = 3 * t;
        while (crossings == 1 ? is_crossed(h) || is_crossed(Topology::previous(h))
                              : !is_crossed(h) || !is_crossed(Topology::previous(h))) {
            ++h;
        }
        const int next = Topology::next(h);
        const int previous = Topology::previous(h);
        const Corner a = corner_of(h);
        const Corner b = corner_of(next);
        const Corner c = corner_of(previous);
        if (crossings == 1) {
            const Corner across = crossing_of(next);
            add(t, sign(height_[b.vertex]), a, b, across);
            add(t, sign(height_[c.vertex]), a, across, c);
            return;
        }
        const Corner ab = crossing_of(h);
        const Corner ca = crossing_of(previous);
        add(t, sign(height_[a.vertex]), a, ab, ca);
        const auto layout = lay_out_triangle(side_lengths(topology_, metric_, t));
        const auto length = [&](const Corner& x, const Corner& y) {
            return (layout * (x.barycentric - y.barycentric)).norm();
        };
        const int side = sign(height_[b.vertex]);
        if (length(ab, c) < length(b, ca)) {
            add(t, side, ab, b, c);
            add(t, side, ab, c, ca);
        } else {
            add(t, side, ab, b, ca);
            add(t, side, b, c, ca);
        }
    }

    const Topology& topology_;
    const IntrinsicMetric& metric_;
    const Eigen::VectorXd& height_;
    LevelSplit split_;
    std::vector<int> corner_;
    std::vector<Vector3> barycentric_;
    std::vector<int> crossing_;  ///< e: vertex on the edge, -1 where it is not crossed
    std::vector<double> share_;  ///< e: where on its lower half-edge
};

}  // namespace

LevelSplit split_along_level(const Topology& topology, const IntrinsicMetric& metric,
                             const Eigen::VectorXd& height, double snap_share, SnapUnit unit) {
    const SnapReach reach(topology, metric, snap_share, unit);
    Snapping snapping(topology, height);
    snapping.run(reach);
    return Cutting(topology, metric, snapping.height(), reach).run();
}

}  // namespace kinequad
