#include "kinequad/symmetry/compute_symmetry_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/symmetry/check_landmarks.h"
#include "kinequad/symmetry/closed_surface.h"
#include "kinequad/symmetry/compute_transport.h"
#include "kinequad/symmetry/find_wrong_landmarks.h"
#include "kinequad/symmetry/map_to_sphere.h"
#include "kinequad/symmetry/sphere_symmetry.h"
#include "kinequad/symmetry/stationary_curve.h"
#include "kinequad/symmetry/surface_distances.h"
#include "kinequad/symmetry/verify_symmetry_map.h"

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

/// What a map is made of before landmarks come in.
struct Prepared {
    const TriangleMesh& mesh;
    const ClosedSurface& surface;
    const SurfaceDistances& distances;
    const SphereMap& sphere;
};

/// The images of the input's vertices (n).
std::vector<SurfacePoint> images_of_input(const ClosedSurface& surface,
                                          const std::vector<SurfacePoint>& closed) {
    std::vector<SurfacePoint> images;
    images.reserve(surface.vertex.size());
    for (const int v : surface.vertex) images.push_back(closed[at(v)]);
    return images;
}

/// Makes the map of `some` of the landmarks and measures all of `landmarks` in it; nothing where
/// `some` make no map.
std::optional<LandmarkTrial> try_landmarks(const Prepared& prepared, const Landmarks& landmarks,
                                           const SphereLandmarks& some, const Context& context) {
    if (2 * some.pairs.size() + some.stationary.size() < 3) return std::nullopt;
    const TriangleMesh& mesh = prepared.mesh;
    const double percent = 100 / bounding_box_diagonal(mesh.V);
    try {
        const SphereSymmetry symmetry =
            find_sphere_symmetry(prepared.surface, prepared.distances, prepared.sphere.points, some,
                                 landmarks.name, context);
        const SphereImages images =
            locate_vertex_images(prepared.surface.topology, symmetry, context);
        const std::vector<SurfacePoint> image =
            images_of_input(prepared.surface, images_on_input(prepared.surface, images));
        const auto distance = [&](int from, int to) {
            const Vector3 there = position_of(image[at(from)], mesh.V, mesh.F);
            return percent * (there - mesh.V.row(to).transpose()).norm();
        };
        LandmarkTrial trial{measure_involution(mesh, image), {}};
        for (const auto& [a, b] : landmarks.pairs) {
            trial.distance_percent.push_back(std::max(distance(a, b), distance(b, a)));
        }
        for (const int v : landmarks.stationary) trial.distance_percent.push_back(distance(v, v));
        return trial;
    } catch (const InputError&) {
        return std::nullopt;
    }
}

/// Looks for what is wrong where the map of all `landmarks`, on the sphere `marks`, is doubtful:
/// throws where leaving one out or exchanging two mends it, else warns, or throws where it is no
/// involution by far.
void settle_doubt(const Prepared& prepared, const Landmarks& landmarks,
                  const SphereLandmarks& marks, const InvolutionError& with_all,
                  const SymmetryOptions& options, const Context& context) {
    Context silent = context;
    silent.log = nullptr;
    silent.progress = nullptr;
    const std::optional<LandmarkDoubt> doubt =
        find_wrong_landmarks(marks, prepared.distances, with_all, [&](const SphereLandmarks& some) {
            return try_landmarks(prepared, landmarks, some, silent);
        });
    std::vector<std::string> names;
    for (const std::size_t i : doubt ? doubt->landmarks : std::vector<std::size_t>{}) {
        names.push_back(describe_landmark(landmarks, i));
    }
    const std::string suspects = fmt::format("{}", fmt::join(names, " and "));
    const std::string symptom = fmt::format(
        "vertices come back {:.1f} % of the diagonal away in the mean, {:.0f} % at most",
        with_all.mean_percent, with_all.max_percent);
    if (doubt && doubt->is_certain) {
        const std::string what =
            doubt->is_exchange
                ? "disagree with the others, and their partners look exchanged; mend both"
                : fmt::format(
                      "disagrees with the others, whose map sends it {:.0f} % of the "
                      "diagonal away; pick it again",
                      doubt->distance_percent);
        throw InputError(InputFault::symmetry,
                         fmt::format("{}: {} {} (with {} {})", landmarks.name, suspects, what,
                                     names.size() > 1 ? "them" : "it", symptom));
    }
    const std::string advice =
        names.empty()
            ? "check them, or add some on limbs that have none"
            : fmt::format("check {} first, or add some on limbs that have none", suspects);
    if (with_all.mean_percent > options.involution_percent) {
        throw InputError(
            InputFault::symmetry,
            fmt::format("{}: the map that follows from these landmarks is no involution ({}); {}",
                        landmarks.name, symptom, advice));
    }
    context.write_log(
        LogLevel::warning,
        fmt::format("{}: the map that follows from these landmarks is not an involution "
                    "everywhere ({}); {}",
                    landmarks.name, symptom, advice));
}

}  // namespace

SymmetryMap compute_symmetry_map(const TriangleMesh& mesh, const IntrinsicMetric& metric,
                                 const Landmarks& landmarks, const SymmetryOptions& options,
                                 const Context& context) {
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    check_landmarks(landmarks, topology);
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
    const SphereSymmetry symmetry =
        find_sphere_symmetry(surface, distances, sphere.points, marks, landmarks.name, context);
    map.quality.fit_rms = symmetry.fit_rms;
    const SphereImages vertices = locate_vertex_images(surface.topology, symmetry, context);
    const SphereImages centres = locate_centre_images(surface, symmetry, vertices, context);
    map.quality.unplaced_points = vertices.unplaced + centres.unplaced;
    context.report_progress("symmetry", 0.8);

    const std::vector<SurfacePoint> closed_images = images_on_input(surface, vertices);
    map.vertex_image = images_of_input(surface, closed_images);
    map.centre_image = centres.points;
    const Transport transport = compute_transport(surface.topology, surface.metric, closed_images,
                                                  map.centre_image, context);
    map.transport = transport.angle;
    map.quality.reversed_triangles = transport.reversed_triangles;

    const Eigen::VectorXd height = (symmetry.points * symmetry.axis).cast<double>();
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
    const InvolutionError error{report.involution_mean_percent, report.involution_max_percent};
    if (is_doubtful(error)) {
        settle_doubt({mesh, surface, distances, sphere}, landmarks, marks, error, options, context);
    }
    warn_of_turned_pairs(landmarks, map.height, context);
    context.write_log(
        LogLevel::info,
        fmt::format("symmetry: {} map from {} landmarks; fit {:.3f}, landmark distances {:.2f} %, "
                    "S(S(p)) {:.3f} % off, {} reversed triangles",
                    map.method, landmarks.pairs.size() + landmarks.stationary.size(),
                    map.quality.fit_rms, map.quality.landmark_difference_percent,
                    report.involution_mean_percent, map.quality.reversed_triangles));
    context.report_progress("symmetry", 1);
    return map;
}

}  // namespace kinequad
