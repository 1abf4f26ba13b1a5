#include "kinequad/symmetry/symmetric_half.h"

#include <algorithm>
#include <limits>

#include "kinequad/core/error.h"
#include "kinequad/mesh/pose_search.h"
#include "kinequad/mesh/split_along_level.h"

namespace kinequad {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Share of an edge within which vertices come to lie on the curve.
constexpr double snap_share = 0.2;

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

}  // namespace

SymmetricHalf take_symmetric_half(const Topology& topology, const IntrinsicMetric& metric,
                                  const SymmetryMap& map, const Positions& V, const Triangles& F) {
    const LevelSplit split = split_along_level(topology, metric, map.height, snap_share);
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
    const std::vector<int> boundary = boundary_half_edges(topology);
    SymmetricHalf half;
    for (int v = 0; v < split.mesh.vertex_count; ++v) {
        if (number[at(v)] < 0) continue;
        number[at(v)] = half.mesh.vertex_count++;
        const bool is_on_curve = split.is_on_level[at(v)] != 0;
        half.is_on_curve.push_back(is_on_curve ? 1 : 0);
        SurfacePoint image = is_on_curve ? points[at(v)] : map.vertex_image[at(v)];
        if (!is_on_curve && topology.is_boundary_vertex(v)) {
            image = nearest_on_edges(topology, boundary, search, search.place(image));
        }
        half.mirrored.push_back(image);
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
    return half;
}

SurfacePoint middle_point(const SymmetricHalf& half, const Topology& topology,
                          const std::vector<Positions>& poses,
                          const std::vector<SurfacePoint>& points, bool is_on_boundary) {
    const PoseSearch search(topology, half.mesh.F, poses);
    PoseSearch::Place wanted =
        PoseSearch::Place::Zero(3, static_cast<Eigen::Index>(poses.size()));
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
                                        const Triangles& F, const std::vector<Positions>& frames,
                                        const std::vector<SurfacePoint>& points,
                                        const Context& context) {
    const Topology half_topology = build_topology(half.mesh.F, half.mesh.vertex_count);
    const PoseSearch search(topology, F, frames);
    const std::vector<int> boundary = boundary_half_edges(topology);
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
        if (boundary_half_edge_of(half_topology, point) >= 0) {
            result.push_back(nearest_on_edges(topology, boundary, search, wanted));
            continue;
        }
        const int start = half.mirrored[at(half.mesh.F(point.triangle, nearest))].triangle;
        result.push_back(search.find(wanted, start));
    }
    return result;
}

}  // namespace kinequad
