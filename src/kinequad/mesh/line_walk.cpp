#include "kinequad/mesh/line_walk.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinequad/core/index.h"

namespace kinequad {
namespace {

constexpr double largest_bend = 50 * std::numbers::pi / 180;
/// A long walk would go around a closed line over and over.
constexpr int most_passed = 1000;

}  // namespace

LineWalk::LineWalk(const Topology& topology, const IntrinsicMetric& metric,
                   const std::vector<int>& edges)
    : topology_(topology),
      metric_(metric),
      is_line_(at(topology.edge_count), 0),
      lines_at_(at(topology.vertex_count)),
      is_passed_(at(topology.vertex_count), 0) {
    for (const int e : edges) {
        if (is_line_[at(e)]) continue;
        is_line_[at(e)] = 1;
        const int h = topology.edge_half_edge[at(e)];
        lines_at_[at(topology.origin[at(h)])].push_back(e);
        lines_at_[at(topology.target(h))].push_back(e);
    }
    for (int v = 0; v < topology.vertex_count; ++v) {
        if (lines_at_[at(v)].size() == 2) is_passed_[at(v)] = is_straight_at(v) ? 1 : 0;
    }
}

/// Whether the angles between the two edges of lines at `v`, on both sides inside the surface, are
/// nearly straight.
bool LineWalk::is_straight_at(int v) const {
    std::vector<double> angles(1, 0);
    for (const int h : outgoing_half_edges(topology_, v)) {
        if (is_line_[at(topology_.edge[at(h)])] && angles.back() > 0) angles.push_back(0);
        angles.back() += corner_angles(side_lengths(topology_, metric_, h / 3))[at(h % 3)];
    }
    if (!topology_.is_boundary_vertex(v)) {
        const int first = topology_.vertex_half_edge[at(v)];
        if (angles.size() == 3 && !is_line_[at(topology_.edge[at(first)])]) {
            angles[0] += angles[2];
            angles.pop_back();
        }
    }
    return std::all_of(angles.begin(), angles.end(), [](double angle) {
        return std::abs(angle - std::numbers::pi) < largest_bend;
    });
}

int LineWalk::edge_of(const SurfacePoint& point) const {
    const int first = 3 * point.triangle;
    for (int k = 0; k < 3; ++k) {
        const int e = topology_.edge[at(first + (k + 1) % 3)];
        if (point.barycentric[k] == 0 && is_line_[at(e)]) return e;
    }
    for (int k = 0; k < 3; ++k) {
        if (point.barycentric[k] != 1) continue;
        const std::vector<int>& lines = lines_at_[at(topology_.origin[at(first + k)])];
        if (!lines.empty()) return lines.front();
    }
    return -1;
}

bool LineWalk::is_passed(const SurfacePoint& point) const {
    if (edge_of(point) < 0) return false;
    for (int k = 0; k < 3; ++k) {
        if (point.barycentric[k] != 1) continue;
        return is_passed_[at(topology_.origin[at(3 * point.triangle + k)])] != 0;
    }
    return true;
}

/// The half-edge of the edge of a line that a point lies on, in its triangle; -1 where there is
/// none.
int LineWalk::half_edge_at(const SurfacePoint& point) const {
    const int e = edge_of(point);
    for (int h = 3 * point.triangle; h < 3 * point.triangle + 3; ++h) {
        if (e >= 0 && topology_.edge[at(h)] == e) return h;
    }
    return -1;
}

SurfacePoint LineWalk::seat(const SurfacePoint& point) const {
    const int e = edge_of(point);
    if (e < 0 || half_edge_at(point) >= 0) return point;
    int corner = 0;
    point.barycentric.maxCoeff(&corner);
    const int v = topology_.origin[at(3 * point.triangle + corner)];
    const int h = topology_.edge_half_edge[at(e)];
    const int own = topology_.origin[at(h)] == v ? h : Topology::next(h);
    return {own / 3, Vector3::Unit(own % 3)};
}

SurfacePoint LineWalk::walk(const SurfacePoint& start, const Vector2& move) const {
    // The direction of the edge has to be known in the frame of the move.
    const int here = half_edge_at(start);
    if (here < 0) return start;
    int e = topology_.edge[at(here)];
    const auto corners = lay_out_triangle(side_lengths(topology_, metric_, start.triangle));
    const Vector2 direction =
        (corners.col(Topology::next(here) % 3) - corners.col(here % 3)).normalized();
    const bool is_lower = topology_.edge_half_edge[at(e)] == here;
    const auto size = [&] { return metric_.edge_length[e]; };
    const double share = start.barycentric[Topology::next(here) % 3];
    double position = size() * (is_lower ? share : 1 - share);
    double left = move.dot(direction) * (is_lower ? 1 : -1);
    for (int passed = 0; position + left < 0 || position + left > size(); ++passed) {
        const int h = topology_.edge_half_edge[at(e)];
        const bool is_forward = left > 0;
        const int v = is_forward ? topology_.target(h) : topology_.origin[at(h)];
        const double way = std::abs(left) - (is_forward ? size() - position : position);
        if (!is_passed_[at(v)] || !(way >= 0) || passed == most_passed) {
            left = is_forward ? size() - position : -position;
            break;
        }
        const std::vector<int>& lines = lines_at_[at(v)];
        e = lines[0] == e ? lines[1] : lines[0];
        const bool leaves_forward = topology_.origin[at(topology_.edge_half_edge[at(e)])] == v;
        position = leaves_forward ? 0 : size();
        left = leaves_forward ? way : -way;
    }
    // A point at an end of an edge would belong to two; it keeps a little away.
    const double whole = size();
    const double end = whole > 0 ? std::clamp((position + left) / whole, 1e-6, 1 - 1e-6) : 0.5;
    const int h = topology_.edge_half_edge[at(e)];
    SurfacePoint point{h / 3, Vector3::Zero()};
    point.barycentric[h % 3] = 1 - end;
    point.barycentric[Topology::next(h) % 3] = end;
    return point;
}

}  // namespace kinequad
