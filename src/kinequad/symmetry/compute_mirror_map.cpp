#include "kinequad/symmetry/compute_mirror_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/core/parallel.h"
#include "kinequad/mesh/closest_point_on_triangle.h"
#include "kinequad/mesh/closest_points.h"
#include "kinequad/symmetry/compute_transport.h"
#include "kinequad/symmetry/match_parts.h"
#include "kinequad/symmetry/stationary_curve.h"
#include "kinequad/symmetry/verify_symmetry_map.h"

namespace kinequad {
namespace {

/// One component of the surface with its own search.
struct Component {
    std::vector<int> triangle;  ///< numbers in the whole mesh
    ClosestPoints search;
};

/// The surface by components, and which one mirrors which.
class MirroredSurface {
public:
    MirroredSurface(const TriangleMesh& mesh, const Topology& topology, const MirrorPlane& plane,
                    const Context& context)
        : mesh_(mesh),
          topology_(topology),
          plane_(plane),
          component_(triangle_components(topology)) {
        const int count = 1 + *std::max_element(component_.begin(), component_.end());
        std::vector<std::vector<int>> members(at(count));
        local_.resize(component_.size());
        for (int t = 0; t < topology.triangle_count; ++t) {
            members[at(component_[at(t)])].push_back(t);
        }
        match_ = match_parts(mesh, members, plane, context);
        for (std::vector<int>& triangles : members) {
            Triangles F(static_cast<Eigen::Index>(triangles.size()), 3);
            for (std::size_t i = 0; i < triangles.size(); ++i) {
                local_[at(triangles[i])] = static_cast<int>(i);
                F.row(static_cast<Eigen::Index>(i)) = mesh.F.row(triangles[i]);
            }
            ClosestPoints search(mesh.V, F);
            components_.push_back({std::move(triangles), std::move(search)});
        }
        normals_.resize(mesh.F.rows(), 3);
        for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
            normals_.row(t) = triangle_area_vector(mesh.V, mesh.F, t).normalized().transpose();
        }
    }

    /// Image of a point of component `component` whose surface faces along `normal`; `hint` is a
    /// triangle probably near the image, or -1.
    SurfacePoint image(const Vector3& point, const Vector3& normal, int component, int hint) const {
        const PartMatch& match = match_[at(component)];
        const Vector3 goal = match.motion(point);
        const Component& partner = components_[at(match.partner)];
        const int local_hint = hint < 0 ? -1 : local_[at(hint)];
        const SurfacePoint local = partner.search.find(goal, local_hint).point;
        const SurfacePoint nearest{partner.triangle[at(local.triangle)], local.barycentric};
        const Vector3 facing = match.motion.linear * normal;
        if (faces(nearest.triangle, facing)) return snapped(nearest, facing);
        // Where parts touch, the nearest point can be that of the other part: the nearest that
        // faces the same way is asked for.
        double best = std::numeric_limits<double>::infinity();
        SurfacePoint result = nearest;
        for (const int t : partner.triangle) {
            if (!faces(t, facing)) continue;
            const TrianglePoint found =
                closest_point_on_triangle(goal, corner(t, 0), corner(t, 1), corner(t, 2));
            if (found.squared_distance < best) {
                best = found.squared_distance;
                result = {t, found.barycentric};
            }
        }
        return snapped(result, facing);
    }

    bool faces(int t, const Vector3& direction) const {
        return normals_.row(t).dot(direction) >= 0;
    }

    /// A point that is a vertex but for rounding as a point of the first triangle there that faces
    /// `facing`: which of several triangles holds it must not be a matter of rounding.
    SurfacePoint snapped(const SurfacePoint& point, const Vector3& facing) const {
        constexpr double rounding = 1e-9;
        for (int k = 0; k < 3; ++k) {
            if (point.barycentric[k] < 1 - rounding) continue;
            int first = 3 * point.triangle + k;
            for (const int h : outgoing_half_edges(topology_, topology_.origin[at(first)])) {
                if (faces(h / 3, facing)) first = std::min(first, h);
            }
            return {first / 3, Vector3::Unit(first % 3)};
        }
        return point;
    }

    Vector3 corner(Eigen::Index t, int k) const { return mesh_.V.row(mesh_.F(t, k)).transpose(); }
    Vector3 triangle_normal(int t) const { return normals_.row(t).transpose(); }
    Vector3 vertex_normal(int v) const {
        Vector3 sum = Vector3::Zero();
        for (const int h : outgoing_half_edges(topology_, v)) {
            sum += triangle_area_vector(mesh_.V, mesh_.F, h / 3);
        }
        return sum.normalized();
    }
    int component_of(int t) const { return component_[at(t)]; }

    /// n: signed heights over the plane in shares of `diagonal`; of a pose that is mirrored part by
    /// part, over the middle between each point and its image.
    Eigen::VectorXd heights(double diagonal) const {
        const double least = 1e-3 * diagonal;
        const std::vector<char> is_positive = positive_parts();
        Eigen::VectorXd height = (mesh_.V * plane_.normal).array() - plane_.offset;
        for (Eigen::Index v = 0; v < height.size(); ++v) {
            const int h = topology_.vertex_half_edge[at(static_cast<int>(v))];
            if (h < 0) continue;
            const int part = component_of(h / 3);
            const PartMatch& match = match_[at(part)];
            const Vector3 p = mesh_.V.row(v).transpose();
            if (is_by_parts()) height[v] = (p - match.motion(p)).dot(plane_.normal) / 2;
            if (match.partner == part) continue;
            // No curve crosses a part whose image is another.
            const double above = std::max(least, std::abs(height[v]));
            height[v] = is_positive[at(part)] != 0 ? above : -above;
        }
        return height / diagonal;
    }

private:
    bool is_by_parts() const { return plane_.residual_percent > symmetric_pose_percent; }

    /// Of two partners the one that is farther on the positive side of the plane.
    std::vector<char> positive_parts() const {
        std::vector<double> height(components_.size(), 0);
        for (std::size_t c = 0; c < components_.size(); ++c) {
            for (const int t : components_[c].triangle) {
                for (int k = 0; k < 3; ++k) height[c] += corner(t, k).dot(plane_.normal);
            }
            height[c] /= 3 * static_cast<double>(components_[c].triangle.size());
        }
        std::vector<char> is_positive(components_.size(), 1);
        for (std::size_t c = 0; c < components_.size(); ++c) {
            const std::size_t other = at(match_[c].partner);
            const bool is_lower = height[c] < height[other];
            const bool is_tie = height[c] == height[other] && c > other;
            if (is_lower || is_tie) is_positive[c] = 0;
        }
        return is_positive;
    }

    const TriangleMesh& mesh_;
    const Topology& topology_;
    const MirrorPlane& plane_;
    std::vector<int> component_;
    std::vector<int> local_;  ///< number of a triangle within its component
    std::vector<Component> components_;
    std::vector<PartMatch> match_;
    Positions normals_;
};

/// Images of all vertices, in breadth-first order, so that each search begins at the image of a
/// neighbour: without a hint a search costs a hundred times as much.
std::vector<SurfacePoint> locate_vertices(const TriangleMesh& mesh, const Topology& topology,
                                          const MirroredSurface& surface, const Context& context) {
    std::vector<SurfacePoint> image(at(topology.vertex_count));
    std::vector<int> hint(image.size(), -1);
    std::vector<bool> is_queued(image.size(), false);
    std::vector<int> queue;
    for (int seed = 0; seed < topology.vertex_count; ++seed) {
        if (is_queued[at(seed)] || topology.vertex_half_edge[at(seed)] < 0) continue;
        is_queued[at(seed)] = true;
        queue.assign(1, seed);
        for (std::size_t i = 0; i < queue.size(); ++i) {
            if (i % 256 == 0) context.check_cancelled();
            const int v = queue[i];
            image[at(v)] = surface.image(mesh.V.row(v).transpose(), surface.vertex_normal(v),
                                         surface.component_of(topology.vertex_half_edge[at(v)] / 3),
                                         hint[at(v)]);
            for (const int h : outgoing_half_edges(topology, v)) {
                for (const int w :
                     {topology.target(h), topology.origin[at(Topology::previous(h))]}) {
                    if (is_queued[at(w)]) continue;
                    is_queued[at(w)] = true;
                    hint[at(w)] = image[at(v)].triangle;
                    queue.push_back(w);
                }
            }
        }
    }
    return image;
}

}  // namespace

SymmetryMap compute_mirror_map(const TriangleMesh& mesh, const MirrorPlane& plane,
                               const IntrinsicMetric& metric, const Context& context) {
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    require(topology.triangle_count > 0, InputFault::mesh,
            "the surface has no triangle; give one with faces");
    const MirroredSurface surface(mesh, topology, plane, context);
    SymmetryMap map;
    map.method = "mirror plane";
    map.quality.mirror_residual_percent = plane.residual_percent;
    map.vertex_image = locate_vertices(mesh, topology, surface, context);
    map.centre_image.resize(at(topology.triangle_count));
    parallel_for(map.centre_image.size(), 256, context, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const int t = static_cast<int>(i);
            const Vector3 centre = triangle_centre(mesh.V, mesh.F, t);
            const int hint = map.vertex_image[at(mesh.F(t, 0))].triangle;
            map.centre_image[i] =
                surface.image(centre, surface.triangle_normal(t), surface.component_of(t), hint);
        }
    });
    const Transport transport =
        compute_transport(topology, metric, map.vertex_image, map.centre_image, context);
    map.transport = transport.angle;
    map.quality.reversed_triangles = transport.reversed_triangles;
    StationaryCurve curve =
        trace_stationary_curve(topology, metric, surface.heights(bounding_box_diagonal(mesh.V)),
                               topology.triangle_count, 0.02);
    require(!curve.polylines.empty(), InputFault::symmetry,
            "the mirror plane does not cut the surface; the line of symmetry would be empty");
    map.height = std::move(curve.height);
    map.stationary = std::move(curve.polylines);
    map.stationary_direction = std::move(curve.directions);
    const SymmetryReport report = verify_symmetry_map(mesh, map);
    if (!report.is_complete) throw VerificationError("symmetry: " + report.problem);
    map.quality.involution_mean_percent = report.involution_mean_percent;
    map.quality.involution_max_percent = report.involution_max_percent;
    context.write_log(LogLevel::info,
                      fmt::format("symmetry: map from a mirror plane; residual {:.4f} %, S(S(p)) "
                                  "{:.3f} % off, {} reversed triangles",
                                  plane.residual_percent, report.involution_mean_percent,
                                  map.quality.reversed_triangles));
    return map;
}

}  // namespace kinequad
