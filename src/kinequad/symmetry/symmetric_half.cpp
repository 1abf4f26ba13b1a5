#include "kinequad/symmetry/symmetric_half.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/mesh/pose_search.h"
#include "kinequad/mesh/split_along_level.h"
#include "kinequad/symmetry/boundary_arcs.h"

namespace kinequad {
namespace {

/// Half-edges of the boundary.
std::vector<int> boundary_half_edges(const Topology& topology) {
    std::vector<int> result;
    for (int h = 0; h < static_cast<int>(topology.twin.size()); ++h) {
        if (topology.twin[at(h)] < 0) result.push_back(h);
    }
    return result;
}

/// The point of the boundary edges `half_edges` nearest to a place.
SurfacePoint nearest_on_edges(const Topology& topology, const std::vector<int>& half_edges,
                              const PoseSearch& search, const PoseSearch::Place& wanted) {
    SurfacePoint best;
    double least = std::numeric_limits<double>::infinity();
    for (const int h : half_edges) {
        const PoseSearch::Place a = search.place(topology.origin[at(h)]);
        const PoseSearch::Place side = search.place(topology.target(h)) - a;
        const double length2 = side.squaredNorm();
        const double along = (wanted - a).cwiseProduct(side).sum();
        const double share = length2 > 0 ? std::clamp(along / length2, 0.0, 1.0) : 0.0;
        const double distance2 = (wanted - a - share * side).squaredNorm();
        if (distance2 >= least) continue;
        least = distance2;
        best = {h / 3, Vector3::Zero()};
        best.barycentric[h % 3] = 1 - share;
        best.barycentric[Topology::next(h) % 3] = share;
    }
    return best;
}

/// Number of corners of its triangle that a point depends on, and which.
std::vector<int> support_of(const SurfacePoint& point) {
    std::vector<int> corners;
    for (int k = 0; k < 3; ++k) {
        if (point.barycentric[k] > 0) corners.push_back(k);
    }
    return corners;
}

/// The half-edge of the boundary that a point lies on, -1 inside. At a vertex one that leaves it.
int boundary_half_edge_of(const Topology& topology, const SurfacePoint& point) {
    const std::vector<int> corners = support_of(point);
    if (corners.size() == 1) {
        const int v = topology.origin[at(3 * point.triangle + corners[0])];
        return topology.is_boundary_vertex(v) ? topology.vertex_half_edge[at(v)] : -1;
    }
    if (corners.size() != 2) return -1;
    const int k = corners[0] == 0 && corners[1] == 2 ? 2 : corners[0];
    const int h = 3 * point.triangle + k;
    return topology.twin[at(h)] < 0 ? h : -1;
}

/// Gives every boundary vertex of the half that is off the curve an image on the boundary: a loop
/// goes to the loop that most of its vertices are mapped next to, evenly by length. One that has no
/// partner there, as a hole that one side of a scan has alone, keeps its image inside the surface.
/// One that the curve crosses goes from crossing to crossing.
class BoundaryMirror {
public:
    BoundaryMirror(const Topology& topology, const IntrinsicMetric& metric,
                   const PoseSearch& search, const std::vector<SurfacePoint>& points)
        : topology_(topology),
          arcs_(topology, metric),
          boundary_(boundary_half_edges(topology)),
          search_(search),
          points_(points) {}

    void run(SymmetricHalf& half) const {
        if (boundary_.empty()) return;
        const Topology half_topology = build_topology(half.mesh.F, half.mesh.vertex_count);
        for (const std::vector<int>& loop : boundary_loops(half_topology)) {
            std::vector<int> vertices;
            vertices.reserve(loop.size() + 1);
            for (const int h : loop) vertices.push_back(half_topology.origin[at(h)]);
            const auto on_curve = [&](int v) { return half.is_on_curve[at(v)] != 0; };
            const auto first = std::find_if(vertices.begin(), vertices.end(), on_curve);
            if (first == vertices.end()) {
                mirror_loop(half, vertices);
                continue;
            }
            std::rotate(vertices.begin(), first, vertices.end());
            vertices.push_back(vertices.front());
            std::vector<int> chain;
            for (const int v : vertices) {
                chain.push_back(v);
                if (!on_curve(v)) continue;
                if (chain.size() > 2) mirror_chain(half, chain);
                chain.assign(1, v);
            }
        }
    }

private:
    BoundaryPlace nearest_place(const SymmetricHalf& half, int v) const {
        return arcs_.locate(
            nearest_on_edges(topology_, boundary_, search_, search_.place(half.mirrored[at(v)])));
    }

    void mirror_loop(SymmetricHalf& half, const std::vector<int>& vertices) const {
        std::map<int, int> votes;
        std::vector<BoundaryPlace> near;
        double distance = 0;
        for (const int v : vertices) {
            near.push_back(nearest_place(half, v));
            ++votes[near.back().loop];
            distance +=
                (search_.place(half.mirrored[at(v)]) - search_.place(arcs_.point_at(near.back())))
                    .norm() /
                static_cast<double>(vertices.size());
        }
        const int loop = std::max_element(votes.begin(), votes.end(), [](auto& a, auto& b) {
                             return a.second < b.second;
                         })->first;
        const int own = arcs_.locate(points_[at(vertices.front())]).loop;
        if (distance > (arcs_.length(own) + arcs_.length(loop)) / 2) return;
        const double ratio = arcs_.length(loop) / std::max(arcs_.length(own), 1e-300);
        const double turn = 2 * std::numbers::pi / arcs_.length(loop);
        Complex start = 0;
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            if (near[i].loop != loop) continue;
            const double here = arcs_.locate(points_[at(vertices[i])]).position;
            start += std::polar(1.0, turn * (near[i].position + ratio * here));
        }
        const double offset = std::arg(start) / turn;
        for (const int v : vertices) {
            const double here = arcs_.locate(points_[at(v)]).position;
            half.mirrored[at(v)] = arcs_.point_at({loop, offset - ratio * here});
        }
    }

    /// `chain` runs along the boundary from one crossing of the curve to the next.
    void mirror_chain(SymmetricHalf& half, const std::vector<int>& chain) const {
        const BoundaryPlace from = arcs_.locate(points_[at(chain.front())]);
        const BoundaryPlace to = arcs_.locate(points_[at(chain.back())]);
        // A chain inside the surface is one of the curve itself.
        if (from.loop < 0 || from.loop != to.loop) return;
        const double whole = arcs_.length(from.loop);
        const auto along = [&](const BoundaryPlace& place) {
            const double way = std::fmod(place.position - from.position, whole);
            return way < 0 ? way + whole : way;
        };
        const double own = along(to);
        if (!(own > 0)) return;
        for (std::size_t i = 1; i + 1 < chain.size(); ++i) {
            const double share = along(arcs_.locate(points_[at(chain[i])])) / own;
            half.mirrored[at(chain[i])] =
                arcs_.point_at({from.loop, from.position - share * (whole - own)});
        }
    }

    const Topology& topology_;
    BoundaryArcs arcs_;
    std::vector<int> boundary_;
    const PoseSearch& search_;
    const std::vector<SurfacePoint>& points_;  ///< of the half's vertices on the input
};

/// The image of a point of the half's boundary between two vertices, if their images are on the
/// boundary of the input.
std::optional<SurfacePoint> mirror_on_boundary(const BoundaryArcs& arcs, const SurfacePoint& a,
                                               const SurfacePoint& b, double share) {
    const BoundaryPlace from = arcs.locate(a);
    const BoundaryPlace to = arcs.locate(b);
    if (from.loop < 0 || from.loop != to.loop) return std::nullopt;
    const double whole = arcs.length(from.loop);
    // The mirror image of the boundary runs the other way around.
    double way = std::fmod(from.position - to.position, whole);
    if (way < 0) way += whole;
    return arcs.point_at({from.loop, from.position - share * way});
}

}  // namespace

LevelSplit insert_stationary_curve(const Topology& topology, const IntrinsicMetric& metric,
                                   const SymmetryMap& map, SnapUnit unit) {
    constexpr double snap_share = 0.2;
    return split_along_level(topology, metric, map.height, snap_share, unit);
}

SymmetricHalf take_symmetric_half(const Topology& topology, const IntrinsicMetric& metric,
                                  const SymmetryMap& map, const Positions& V, const Triangles& F) {
    const LevelSplit split = insert_stationary_curve(topology, metric, map);
    const std::vector<SurfacePoint> points = vertex_points(split.mesh);
    std::vector<int> triangles;
    std::vector<int> number(at(split.mesh.vertex_count), -1);
    for (int t = 0; t < static_cast<int>(split.side.size()); ++t) {
        if (split.side[at(t)] < 0) continue;
        triangles.push_back(t);
        for (int k = 0; k < 3; ++k) number[at(split.mesh.F(t, k))] = 0;
    }
    require(!triangles.empty(), InputFault::symmetry,
            "the symmetry map has no positive side; check the landmarks");

    const std::vector<Positions> shapes = {V};
    const PoseSearch search(topology, F, shapes);
    SymmetricHalf half;
    std::vector<SurfacePoint> half_points;
    for (int v = 0; v < split.mesh.vertex_count; ++v) {
        if (number[at(v)] < 0) continue;
        number[at(v)] = half.mesh.vertex_count++;
        const bool is_on_curve = split.is_on_level[at(v)] != 0;
        half.is_on_curve.push_back(is_on_curve ? 1 : 0);
        half.mirrored.push_back(is_on_curve ? points[at(v)] : map.vertex_image[at(v)]);
        half_points.push_back(points[at(v)]);
    }
    half.mesh.F.resize(static_cast<Eigen::Index>(triangles.size()), 3);
    half.mesh.barycentric.resize(3 * half.mesh.F.rows(), 3);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const int t = triangles[i];
        const auto row = static_cast<Eigen::Index>(i);
        half.mesh.parent.push_back(split.mesh.parent[at(t)]);
        half.mesh.barycentric.middleRows<3>(3 * row) =
            split.mesh.barycentric.middleRows<3>(3 * static_cast<Eigen::Index>(t));
        for (int k = 0; k < 3; ++k) half.mesh.F(row, k) = number[at(split.mesh.F(t, k))];
    }
    BoundaryMirror(topology, metric, search, half_points).run(half);
    return half;
}

SurfacePoint middle_point(const SymmetricHalf& half, const Topology& topology,
                          const std::vector<Positions>& poses,
                          const std::vector<SurfacePoint>& points, bool is_on_boundary) {
    const PoseSearch search(topology, half.mesh.F, poses);
    PoseSearch::Place wanted = PoseSearch::Place::Zero(3, static_cast<Eigen::Index>(poses.size()));
    for (const SurfacePoint& point : points) {
        wanted += search.place(point) / static_cast<double>(points.size());
    }
    return is_on_boundary
               ? nearest_on_edges(topology, boundary_half_edges(topology), search, wanted)
               : search.find(wanted, points.front().triangle);
}

bool lies_on_curve(const SymmetricHalf& half, const Topology& topology, const SurfacePoint& point) {
    for (const int k : support_of(point)) {
        if (!half.is_on_curve[at(half.mesh.F(point.triangle, k))]) return false;
    }
    return boundary_half_edge_of(topology, point) >= 0;
}

std::vector<SurfacePoint> mirror_points(const SymmetricHalf& half, const Topology& topology,
                                        const IntrinsicMetric& metric, const Triangles& F,
                                        const std::vector<Positions>& frames,
                                        const std::vector<SurfacePoint>& points,
                                        const Context& context) {
    const Topology half_topology = build_topology(half.mesh.F, half.mesh.vertex_count);
    const PoseSearch search(topology, F, frames);
    const BoundaryArcs arcs(topology, metric);
    std::vector<SurfacePoint> result;
    result.reserve(points.size());
    for (const SurfacePoint& point : points) {
        if (result.size() % 256 == 0) context.check_cancelled();
        if (lies_on_curve(half, half_topology, point)) {
            result.push_back(point_of_input(half.mesh, point));
            continue;
        }
        PoseSearch::Place wanted =
            PoseSearch::Place::Zero(3, static_cast<Eigen::Index>(frames.size()));
        int nearest = 0;
        for (int k = 0; k < 3; ++k) {
            if (point.barycentric[k] > point.barycentric[nearest]) nearest = k;
            if (!(point.barycentric[k] > 0)) continue;
            const int v = half.mesh.F(point.triangle, k);
            wanted += point.barycentric[k] * search.place(half.mirrored[at(v)]);
        }
        const int h = boundary_half_edge_of(half_topology, point);
        std::optional<SurfacePoint> on_boundary;
        if (h >= 0) {
            const double share =
                point.triangle == h / 3 ? point.barycentric[Topology::next(h) % 3] : 0.0;
            on_boundary = mirror_on_boundary(arcs, half.mirrored[at(half_topology.origin[at(h)])],
                                             half.mirrored[at(half_topology.target(h))], share);
        }
        const int start = half.mirrored[at(half.mesh.F(point.triangle, nearest))].triangle;
        result.push_back(on_boundary ? *on_boundary : search.find(wanted, start));
    }
    return result;
}

}  // namespace kinequad
