#include "kinequad/symmetry/compute_symmetry_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/core/parallel.h"
#include "kinequad/symmetry/check_landmarks.h"
#include "kinequad/symmetry/closed_surface.h"
#include "kinequad/symmetry/compute_transport.h"
#include "kinequad/symmetry/locate_on_sphere.h"
#include "kinequad/symmetry/map_to_sphere.h"
#include "kinequad/symmetry/match_extremities.h"
#include "kinequad/symmetry/stationary_curve.h"
#include "kinequad/symmetry/surface_distances.h"
#include "kinequad/symmetry/verify_symmetry_map.h"
#include "kinequad/symmetry/warp_to_landmarks.h"

namespace kinequad {
namespace {

SphereLandmarks to_sphere_landmarks(const Landmarks& landmarks, const ClosedSurface& surface) {
    SphereLandmarks result;
    for (const auto& [a, b] : landmarks.pairs) {
        result.pairs.push_back({surface.vertex[at(a)], surface.vertex[at(b)]});
    }
    for (const int v : landmarks.stationary) result.stationary.push_back(surface.vertex[at(v)]);
    return result;
}

std::vector<int> all_vertices(const SphereLandmarks& landmarks) {
    std::vector<int> result = landmarks.stationary;
    for (const auto& pair : landmarks.pairs) result.insert(result.end(), pair.begin(), pair.end());
    // The order of picking decides nothing.
    std::sort(result.begin(), result.end());
    return result;
}

struct Images {
    std::vector<SurfacePoint> vertex;  ///< on the closed surface
    std::vector<SurfacePoint> centre;
    int unplaced = 0;
};

/// Images of all vertices of the closed surface, in breadth-first order, so that each search starts
/// at the image of a neighbour.
void locate_vertices(const Topology& topology, const SpherePoints& points, const RealVector3& axis,
                     Images& images, const Context& context) {
    images.vertex.assign(at(topology.vertex_count), SurfacePoint{});
    std::vector<int> queue;
    std::vector<int> hint(at(topology.vertex_count), -1);
    queue.push_back(topology.origin.front());
    hint[at(queue.front())] = 0;
    for (std::size_t i = 0; i < queue.size(); ++i) {
        if (i % 1024 == 0) context.check_cancelled();
        const int v = queue[i];
        const SphereLocation found = locate_on_sphere(
            topology, points, mirrored(points.row(v).transpose(), axis), hint[at(v)]);
        images.vertex[at(v)] = found.point;
        if (!found.is_inside) ++images.unplaced;
        for (const int h : outgoing_half_edges(topology, v)) {
            int& next = hint[at(topology.target(h))];
            if (next >= 0) continue;
            next = found.point.triangle;
            queue.push_back(topology.target(h));
        }
    }
}

void locate_centres(const ClosedSurface& surface, const SpherePoints& points,
                    const RealVector3& axis, Images& images, const Context& context) {
    images.centre.resize(at(surface.triangle_count));
    std::vector<char> is_outside(images.centre.size(), 0);
    parallel_for(images.centre.size(), 512, context, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const auto row = static_cast<Eigen::Index>(t);
            const RealVector3 sum = (points.row(surface.F(row, 0)) + points.row(surface.F(row, 1)) +
                                     points.row(surface.F(row, 2)))
                                        .transpose();
            const int start = images.vertex[at(surface.F(row, 0))].triangle;
            const SphereLocation found =
                locate_on_sphere(surface.topology, points, mirrored(sum.normalized(), axis), start);
            images.centre[t] = surface.to_input(found.point);
            is_outside[t] = found.is_inside ? 0 : 1;
        }
    });
    images.unplaced += static_cast<int>(std::count(is_outside.begin(), is_outside.end(), 1));
}

/// Warps to the landmarks, then once more with the ends of limbs that these miss.
SpherePoints warp_and_extend(const ClosedSurface& surface, const SurfaceDistances& distances,
                             const SphereLandmarks& marks, const SpherePoints& points,
                             const RealVector3& axis, const Context& context) {
    SpherePoints warped = warp_to_landmarks(points, marks, axis, context);
    const SphereLandmarks more =
        match_extremities(surface.topology, surface.metric, distances, warped, axis);
    if (more.pairs.empty() && more.stationary.empty()) return warped;
    context.write_log(
        LogLevel::info,
        fmt::format("symmetry: {} pairs of limb ends and {} ends on the line of symmetry added to "
                    "the landmarks",
                    more.pairs.size(), more.stationary.size()));
    SphereLandmarks all = marks;
    all.pairs.insert(all.pairs.end(), more.pairs.begin(), more.pairs.end());
    all.stationary.insert(all.stationary.end(), more.stationary.begin(), more.stationary.end());
    return warp_to_landmarks(points, all, axis, context);
}

void require_fit(const AntiInvolution& fit) {
    require(fit.definiteness > 1e-14, InputFault::symmetry,
            "landmarks: more than one symmetry fits them; add pairs far from each other, or points "
            "on the line of symmetry");
    require(fit.is_reflection, InputFault::symmetry,
            "landmarks: no reflection of the surface fits them; check that each pair joins left "
            "and right, and that stationary vertices lie on the line of symmetry");
}

}  // namespace

SymmetryMap compute_symmetry_map(const TriangleMesh& mesh, const IntrinsicMetric& metric,
                                 const Landmarks& landmarks, const SymmetryOptions& options,
                                 const Context& context) {
    check_landmarks(landmarks, static_cast<int>(mesh.V.rows()));
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    const ClosedSurface surface = close_surface(mesh, topology, metric, context);
    const SphereLandmarks marks = to_sphere_landmarks(landmarks, surface);
    context.report_progress("symmetry", 0);
    const SurfaceDistances distances =
        tabulate_distances(surface.topology, surface.metric, all_vertices(marks), 12, 4);
    SymmetryMap map;
    map.quality.landmark_difference_percent =
        compare_landmark_distances(distances, marks, landmarks, options.landmark_percent);
    const SphereMap sphere =
        map_to_sphere(surface.topology, surface.metric, distances.mean, context);
    context.report_progress("symmetry", 0.6);

    map.method = sphere.is_uniform ? "conformal" : "harmonic";
    const AntiInvolution fit = fit_anti_involution(sphere.points, marks);
    require_fit(fit);
    map.quality.fit_rms = fit.rms;
    SpherePoints points = sphere.points;
    const RealVector3 axis = move_to_great_circle(points, fit);
    points = warp_and_extend(surface, distances, marks, points, axis, context);
    Images images;
    locate_vertices(surface.topology, points, axis, images, context);
    locate_centres(surface, points, axis, images, context);
    context.report_progress("symmetry", 0.8);

    map.vertex_image.resize(at(topology.vertex_count));
    for (SurfacePoint& image : images.vertex) {
        if (image.triangle >= 0) image = surface.to_input(image);
    }
    for (std::size_t v = 0; v < map.vertex_image.size(); ++v) {
        map.vertex_image[v] = images.vertex[at(surface.vertex[v])];
    }
    map.centre_image = std::move(images.centre);
    const Transport transport = compute_transport(surface.topology, surface.metric, images.vertex,
                                                  map.centre_image, context);
    map.transport = transport.angle;
    map.quality.reversed_triangles = transport.reversed_triangles;
    map.quality.unplaced_points = images.unplaced;

    const Eigen::VectorXd height = (points * axis).cast<double>();
    StationaryCurve curve = trace_stationary_curve(surface.topology, surface.metric, height,
                                                   surface.triangle_count, 0.999);
    map.stationary = std::move(curve.polylines);
    map.stationary_direction = std::move(curve.directions);
    map.height.resize(topology.vertex_count);
    for (int v = 0; v < topology.vertex_count; ++v) {
        map.height[v] = curve.height[surface.vertex[at(v)]];
    }
    const SymmetryReport report = verify_symmetry_map(mesh, map);
    if (!report.is_complete) throw VerificationError("symmetry: " + report.problem);
    map.quality.involution_mean_percent = report.involution_mean_percent;
    map.quality.involution_max_percent = report.involution_max_percent;
    if (report.involution_mean_percent > options.involution_percent) {
        throw InputError(
            InputFault::symmetry,
            fmt::format(
                "landmarks: the map that follows from them is no involution (vertices come "
                "back {:.1f} % of the diagonal away); check the pairs, or add some on limbs "
                "that have none",
                report.involution_mean_percent));
    }
    context.write_log(
        LogLevel::info,
        fmt::format("symmetry: {} map from {} landmarks; fit {:.3f}, landmark distances {:.2f} %, "
                    "S(S(p)) {:.3f} % off, {} reversed triangles",
                    map.method, landmarks.pairs.size() + landmarks.stationary.size(), fit.rms,
                    map.quality.landmark_difference_percent, report.involution_mean_percent,
                    map.quality.reversed_triangles));
    context.report_progress("symmetry", 1);
    return map;
}

}  // namespace kinequad
