#include "kinequad/pipeline/quadrangulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/deformation/mean_shear.h"
#include "kinequad/extract/verify_quad_mesh.h"
#include "kinequad/gridmap/compute_grid_map.h"
#include "kinequad/io/memory_sequence.h"
#include "kinequad/mesh/feature_edges.h"
#include "kinequad/mesh/widen_flat_triangles.h"
#include "kinequad/pipeline/check_input.h"
#include "kinequad/pipeline/refine_coarse_input.h"
#include "kinequad/pipeline/solve_quads.h"
#include "kinequad/pipeline/solved_input.h"
#include "kinequad/pipeline/symmetric_quads.h"

namespace kinequad {
namespace {

Positions read_reference_frame(const FrameSource& source, int reference) {
    return reference == Options::rest_shape ? source.read_rest_shape()
                                            : source.read_frame(reference);
}

/// The feature edges of the input, by angle and by name.
std::vector<int> find_features(const Topology& topology, const Positions& reference,
                               const Options& options) {
    std::vector<int> features = edges_between(topology, options.features, "features");
    if (options.feature_angle > 0) {
        const std::vector<int> sharp =
            find_feature_edges(topology, reference, options.feature_angle);
        features.insert(features.end(), sharp.begin(), sharp.end());
        std::sort(features.begin(), features.end());
        features.erase(std::unique(features.begin(), features.end()), features.end());
    }
    return features;
}

/// Whether quads for the mean lengths would shear the reference pose (n x 3) for little: the frames
/// differ so much from one another that none is like their mean. docs/deformation.md
bool is_reference_better(const FrameSource& frames, const Topology& topology,
                         const IntrinsicMetric& mean, const Positions& reference,
                         const Context& context) {
    constexpr double least_gain = 0.3;
    constexpr double most_cost = 0.2;
    if (frames.frame_count() < 2) return false;
    const IntrinsicMetric pose = widen_flat_triangles(topology, metric_of(topology, reference));
    const MetricComparison comparison = compare_metrics(frames, topology, mean, pose, context);
    const bool result =
        comparison.cost > most_cost && comparison.gain < least_gain * comparison.cost;
    context.write_log(LogLevel::info,
                      fmt::format("metric: the mean shears frames by {:.4f} less, the reference by "
                                  "{:.4f}; quads are for the {}",
                                  comparison.gain, comparison.cost, result ? "reference" : "mean"));
    return result;
}

/// Every component needs area, or no quad can lie on it.
void check_areas(const FrameSource& source, const Topology& topology,
                 const IntrinsicMetric& metric) {
    const Eigen::VectorXd areas = triangle_areas(topology, metric);
    const std::vector<int> component = triangle_components(topology);
    Eigen::VectorXd area_of_component =
        Eigen::VectorXd::Zero(1 + *std::max_element(component.begin(), component.end()));
    for (int t = 0; t < topology.triangle_count; ++t) {
        area_of_component[component[at(t)]] += areas[t];
    }
    for (int t = 0; t < topology.triangle_count; ++t) {
        const double area = area_of_component[component[at(t)]];
        if (area > 0 && std::isfinite(area)) continue;
        throw InputError(
            InputFault::mesh,
            fmt::format("{}: the connected part with triangle {} has no area; remove it",
                        source.name(), t));
    }
}

/// Surfaces of symmetric runs are refined only where they are coarse, and have to have triangles
/// enough for a field of their own on every connected part.
void require_symmetric_detail(const FrameSource& source, const Topology& topology) {
    constexpr int least_triangles = 4;
    const std::vector<int> component = triangle_components(topology);
    std::vector<int> count(
        static_cast<std::size_t>(1 + *std::max_element(component.begin(), component.end())), 0);
    for (const int c : component) ++count[at(c)];
    for (int t = 0; t < topology.triangle_count; ++t) {
        const int triangles = count[at(component[at(t)])];
        if (triangles >= least_triangles) continue;
        throw InputError(
            InputFault::symmetry,
            fmt::format("{}: the connected part with triangle {} has {} triangle{}, too few for "
                        "symmetric quads; subdivide it, or run with --symmetry none",
                        source.name(), t, triangles, triangles == 1 ? "" : "s"));
    }
}

/// Whether the surface may be refined before it is solved on. Landmarks match parts that were
/// modelled apart along their seams, which would not fit any more where both sides are cut.
bool can_be_refined(const Result& result, const std::optional<Landmarks>& landmarks) {
    return result.options.symmetry == SymmetryMode::none || !landmarks ||
           count_surface(result.topology).components == 1;
}

/// Quads with the symmetry that the run asks for; where no mirrored ones are found, says what may
/// be instead.
QuadMesh solve_symmetric(const SolvedSurface& solved, Result& result, const Context& context,
                         const StageEnd& finish_stage) {
    if (result.options.symmetry == SymmetryMode::field) {
        return solve_symmetric_field(solved, result, context, finish_stage);
    }
    try {
        return solve_mirrored_half(solved, result, context, finish_stage);
    } catch (const GridMapError& error) {
        throw GridMapError(
            fmt::format("{}; or run with --symmetry field, whose quads need not mirror exactly",
                        error.what()),
            error.depends_on_density());
    }
}

/// Says where the wanted number of vertices was missed, and why.
void note_density(Result& result, const Context& context) {
    constexpr double allowed = 0.1;
    const double wanted =
        result.options.edge_length > 0 ? result.map.wanted_quads : result.options.vertices;
    const double made = result.options.edge_length > 0
                            ? result.map.quads
                            : static_cast<double>(result.quads.vertex.size());
    if (std::abs(made / wanted - 1) <= allowed) return;
    const SurfaceCounts counts = count_surface(result.topology);
    const auto singular = (result.field.index.array() != 0).count();
    result.notes.push_back(fmt::format(
        "{:.0f} {} instead of {:.0f}: {} singularities and corners on {} parts with {} boundary "
        "loops {}",
        made, result.options.edge_length > 0 ? "quads" : "vertices", wanted, singular,
        counts.components, counts.boundary_loops,
        made > wanted ? "need as many" : "leave no closer number"));
    context.write_log(LogLevel::warning, result.notes.back());
}

/// Takes quads and domain from the refined mesh to the input.
void put_on_input(Result& result) {
    if (!result.refined) return;
    for (SurfacePoint& point : result.quads.vertex) point = point_of_input(*result.refined, point);
    SymmetricHalf& surface = result.domain.surface;
    for (SurfacePoint& point : surface.mirrored) {
        if (point.triangle >= 0) point = point_of_input(*result.refined, point);
    }
    surface.mesh = as_refinement_of_input(*result.refined, surface.mesh);
}

}  // namespace

Result quadrangulate(const FrameSource& source, const std::optional<Landmarks>& landmarks,
                     const Options& options, const Context& context, const StageObserver& observe) {
    Result result;
    StageClock clock;
    const auto finish_stage = [&](const char* stage) {
        clock.finish_stage(stage, result.times);
        if (observe) observe(stage, result);
    };

    result.options = resolve_options(options, source.frame_count(), source.has_rest_shape(),
                                     landmarks.has_value());
    result.reference = read_reference_frame(source, result.options.reference);
    require_valid_input(source, result.reference, context);
    result.topology = build_topology(source.triangles(), source.vertex_count());
    result.features = find_features(result.topology, result.reference, result.options);
    if (landmarks) require_landmarks_fit(*landmarks, source.vertex_count());
    if (can_be_refined(result, landmarks)) {
        result.refined = refine_coarse_input(result.topology, result.reference, result.features,
                                             result.options, context);
    }
    finish_stage("check");

    // From here on the surface is the refined one, up to the finished quads.
    const SolvedInput input(source, result.topology, result.reference, result.refined);
    const FrameSource& surface = input.frames();
    const Positions& reference = input.reference();
    const Topology& topology = input.topology();

    // A run on a single pose sees the reference as if it were the whole sequence.
    std::optional<MemorySequence> pose;
    if (is_single_pose(result.options)) {
        pose.emplace(surface.triangles(), std::vector<Positions>{reference}, std::nullopt,
                     surface.name());
    }
    const FrameSource& frames = pose ? *pose : surface;
    IntrinsicMetric metric =
        choose_metric(frames, topology, reference, *result.options.metric, context);
    const bool is_choice_free = !options.metric && result.options.metric == MetricChoice::mean &&
                                result.options.symmetry == SymmetryMode::none &&
                                result.options.field == CrossFieldMethod::convex;
    if (is_choice_free && is_reference_better(frames, topology, metric, reference, context)) {
        result.options.metric = MetricChoice::reference;
        metric = choose_metric(frames, topology, reference, *result.options.metric, context);
    }
    check_areas(source, result.topology, metric_of(result.topology, result.reference));
    result.edge_length = result.options.edge_length > 0
                             ? result.options.edge_length
                             : edge_length_for(topology, metric, result.options.vertices);
    result.domain.surface.mesh = as_refined_mesh(surface.triangles(), surface.vertex_count());
    result.domain.surface.is_on_curve.assign(static_cast<std::size_t>(surface.vertex_count()), 0);
    result.domain.topology = topology;
    result.domain.metric = metric;
    finish_stage("metric");

    const SolvedSurface solved{frames, topology, metric, reference};
    if (result.options.symmetry == SymmetryMode::none) {
        const std::vector<DomainView> views = {{frames, reference, metric}};
        result.options = list_recipes(result.options).front();
        measure_deformation(views, result, context, finish_stage);
        solve_field(result, context);
        finish_stage("field");
        const QuadMesh quads = map_and_extract(views, result, context, finish_stage);
        result.quads = relax_on_domain(result.domain, views, result.map.feature_edges, quads,
                                       result.options, context);
    } else {
        require_symmetric_detail(source, topology);
        result.symmetry = find_symmetry(frames, metric, landmarks, reference, context);
        result.quads = solve_symmetric(solved, result, context, finish_stage);
    }
    put_on_input(result);
    note_density(result, context);
    require_valid(verify_quad_mesh(result.quads, result.topology));
    finish_stage("relaxation");
    return result;
}

}  // namespace kinequad
