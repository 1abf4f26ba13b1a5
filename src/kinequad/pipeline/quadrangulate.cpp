#include "kinequad/pipeline/quadrangulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "kinequad/core/error.h"
#include "kinequad/deformation/compute_deformation_tensors.h"
#include "kinequad/deformation/compute_mean_metric.h"
#include "kinequad/extract/extract_quads.h"
#include "kinequad/extract/verify_quad_mesh.h"
#include "kinequad/field/compute_cross_field.h"
#include "kinequad/field/cross_field_targets.h"
#include "kinequad/field/verify_cross_field.h"
#include "kinequad/gridmap/compute_grid_map.h"
#include "kinequad/io/memory_sequence.h"
#include "kinequad/mesh/feature_edges.h"
#include "kinequad/relax/relax_quads.h"

namespace kinequad {
namespace {

Topology checked_topology(const FrameSource& source) {
    try {
        require(source.triangles().rows() > 0, InputFault::mesh, "has no faces; nothing to do");
        return build_topology(source.triangles(), source.vertex_count());
    } catch (const InputError& error) {
        throw InputError(error.fault(), fmt::format("{}: {}", source.name(), error.what()));
    }
}

Positions read_reference_frame(const FrameSource& source, int reference) {
    return reference == Options::rest_shape ? source.read_rest_shape()
                                            : source.read_frame(reference);
}

/// Every component needs area, or no quad can lie on it.
void check_areas(const FrameSource& source, const Topology& topology,
                 const IntrinsicMetric& metric) {
    const Eigen::VectorXd areas = triangle_areas(topology, metric);
    const std::vector<int> component = triangle_components(topology);
    Eigen::VectorXd area_of_component =
        Eigen::VectorXd::Zero(1 + *std::max_element(component.begin(), component.end()));
    for (int t = 0; t < topology.triangle_count; ++t) {
        area_of_component[component[static_cast<std::size_t>(t)]] += areas[t];
    }
    for (int t = 0; t < topology.triangle_count; ++t) {
        const double area = area_of_component[component[static_cast<std::size_t>(t)]];
        if (area > 0 && std::isfinite(area)) continue;
        throw InputError(
            InputFault::mesh,
            fmt::format("{}: the connected part with triangle {} has no area; remove it",
                        source.name(), t));
    }
}

void require_valid_field(const CrossFieldReport& report) {
    if (report.valid()) return;
    throw VerificationError(fmt::format(
        "the cross field is not valid: index sum {} instead of {} quarters, {} wrong indices, {} "
        "broken holonomies, {} unaligned triangles; please report this input",
        report.index_sum, report.expected_index_sum, report.wrong_indices, report.broken_holonomies,
        report.unaligned_triangles));
}

CrossField make_cross_field(const Result& result, const Context& context) {
    CrossFieldTargetOptions target_options;
    target_options.method = result.options.field;
    target_options.alpha = *result.options.alpha;
    target_options.curvature_weight = result.options.curvature;
    target_options.edge_length = result.edge_length;
    const CrossFieldTargets targets =
        compute_cross_field_targets(result.topology, result.metric, result.tensors, target_options);
    CrossFieldOptions options;
    options.method = result.options.field;
    options.singularity_cost = result.options.singularity_cost;
    options.edge_length = result.edge_length;
    if (result.options.feature_angle > 0) {
        options.feature_edges =
            find_feature_edges(result.topology, result.reference, result.options.feature_angle);
    }
    CrossField field =
        compute_cross_field(result.topology, result.metric, targets, options, context);
    require_valid_field(verify_cross_field(result.topology, result.metric, field, options));
    return field;
}

void require_valid_map(const GridMap& map) {
    const GridMapReport report = verify_grid_map(map);
    if (report.valid()) return;
    throw VerificationError(fmt::format(
        "the grid map is not valid: {} flipped triangles, {} broken transitions, {} fractional "
        "translations, {} singularities off the grid, {} wrong cone angles, {} boundary edges off "
        "their "
        "lines; please report this input",
        report.flipped_triangles, report.broken_transitions, report.fractional_translations,
        report.fractional_singularities, report.wrong_cone_angles,
        report.unaligned_boundary_edges));
}

}  // namespace

Result quadrangulate(const FrameSource& source, const Options& options, const Context& context,
                     const StageObserver& observe) {
    Result result;
    StageClock clock;
    const auto finish_stage = [&](const char* stage) {
        clock.finish_stage(stage, result.times);
        if (observe) observe(stage, result);
    };

    result.options = resolve_options(options, source.frame_count(), source.has_rest_shape());
    result.topology = checked_topology(source);
    result.reference = read_reference_frame(source, result.options.reference);
    finish_stage("check");

    result.metric = result.options.metric == MetricChoice::reference
                        ? metric_of(result.topology, result.reference)
                        : compute_mean_metric(source, result.topology, context);
    check_areas(source, result.topology, result.metric);
    result.edge_length =
        result.options.edge_length > 0
            ? result.options.edge_length
            : edge_length_for(result.topology, result.metric, result.options.vertices);
    finish_stage("metric");

    // A run on a single pose sees the reference as if it were the whole sequence.
    std::optional<MemorySequence> pose;
    if (is_single_pose(result.options)) {
        pose.emplace(source.triangles(), std::vector<Positions>{result.reference}, std::nullopt,
                     source.name());
    }
    const FrameSource& frames = pose ? *pose : source;
    DeformationOptions deformation_options;
    deformation_options.edge_length = result.edge_length;
    result.tensors = compute_deformation_tensors(frames, result.topology, result.metric,
                                                 deformation_options, context);
    finish_stage("deformation");

    // A symmetry map, once there is one, is made here and joins the targets of the field.

    result.field = make_cross_field(result, context);
    finish_stage("field");

    GridMapOptions map_options;
    map_options.vertex_count = result.options.vertices;
    map_options.edge_length = result.options.edge_length;
    result.map =
        compute_grid_map(result.topology, result.metric, result.field, map_options, context);
    require_valid_map(result.map);
    finish_stage("map");

    result.quads = extract_quads(result.map, context);
    require_valid(verify_quad_mesh(result.quads, result.topology));
    finish_stage("extraction");

    if (result.options.relax_rounds > 0) {
        RelaxOptions relax_options;
        relax_options.rounds = result.options.relax_rounds;
        relax_options.reference_is_rest_shape =
            !pose && result.options.reference == Options::rest_shape;
        relax_options.reference_frame =
            pose || relax_options.reference_is_rest_shape ? 0 : result.options.reference;
        result.quads = relax_quads(result.quads, frames, result.topology, result.metric,
                                   relax_options, context);
        require_valid(verify_quad_mesh(result.quads, result.topology));
    }
    finish_stage("relaxation");
    return result;
}

}  // namespace kinequad
