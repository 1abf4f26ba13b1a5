#include "kinequad/pipeline/solve_quads.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/deformation/compute_deformation_tensors.h"
#include "kinequad/deformation/compute_mean_metric.h"
#include "kinequad/extract/extract_quads.h"
#include "kinequad/extract/split_rows.h"
#include "kinequad/extract/verify_quad_mesh.h"
#include "kinequad/field/compute_cross_field.h"
#include "kinequad/field/cross_field_targets.h"
#include "kinequad/field/symmetrise_field.h"
#include "kinequad/field/verify_cross_field.h"
#include "kinequad/gridmap/compute_grid_map.h"
#include "kinequad/mesh/feature_edges.h"
#include "kinequad/mesh/widen_flat_triangles.h"
#include "kinequad/relax/relax_quads.h"

namespace kinequad {
namespace {

DeformationTensors sum_of_tensors(const std::vector<DomainView>& views, const Result& result,
                                  const Context& context) {
    DeformationOptions options;
    options.edge_length = result.edge_length;
    std::optional<DeformationTensors> sum;
    for (const DomainView& view : views) {
        DeformationTensors tensors = compute_deformation_tensors(
            view.frames, result.domain.topology, view.metric, options, context);
        sum = sum ? add_tensors(*sum, tensors) : std::move(tensors);
    }
    return *sum;
}

void require_valid_field(const CrossFieldReport& report) {
    if (report.valid()) return;
    throw VerificationError(fmt::format(
        "the cross field is not valid: index sum {} instead of {} quarters, {} wrong indices, {} "
        "broken holonomies, {} unaligned triangles; please report this input",
        report.index_sum, report.expected_index_sum, report.wrong_indices, report.broken_holonomies,
        report.unaligned_triangles));
}

/// Weight of the symmetry term in the energy whose smoothness counts 1: singular vertices pair up,
/// and what the map of the symmetry gets wrong is not followed.
constexpr double symmetry_weight = 0.05;

/// Weight of the symmetrised field as soft constraint, in the energy whose smoothness counts 1: the
/// paper's, or one that keeps pairs of singularities but leaves the field free to lose some.
double orbit_weight(const Options& options) {
    constexpr double gentle = 0.15;
    return options.field == CrossFieldMethod::paper ? *options.alpha / (1 - *options.alpha)
                                                    : gentle;
}

/// Multiplies the factor (n) of singularities on those connected parts that have fewer than
/// `least_room` quads of `edge_length` for each. Returns whether there are any.
bool price_crowds(const Topology& topology, const IntrinsicMetric& metric, double edge_length,
                  const CrossField& field, std::vector<double>& cost_factor) {
    constexpr double least_room = 8;
    constexpr double increase = 4;
    const std::vector<int> part = triangle_components(topology);
    const int parts = 1 + *std::max_element(part.begin(), part.end());
    const Eigen::VectorXd areas = triangle_areas(topology, metric);
    std::vector<double> quads(static_cast<std::size_t>(parts), 0);
    std::vector<int> singular(static_cast<std::size_t>(parts), 0);
    std::vector<int> part_of_vertex(static_cast<std::size_t>(topology.vertex_count), -1);
    for (int t = 0; t < topology.triangle_count; ++t) {
        const int p = part[at(t)];
        quads[at(p)] += areas[t] / (edge_length * edge_length);
        for (int h = 3 * t; h < 3 * t + 3; ++h) {
            part_of_vertex[at(topology.origin[at(h)])] = p;
        }
    }
    // Corners of the boundary have to be where they are.
    const auto is_counted = [&](int v) {
        return part_of_vertex[at(v)] >= 0 && !topology.is_boundary_vertex(v);
    };
    for (int v = 0; v < topology.vertex_count; ++v) {
        if (is_counted(v) && field.index[v] != 0) ++singular[at(part_of_vertex[at(v)])];
    }
    bool found = false;
    cost_factor.resize(static_cast<std::size_t>(topology.vertex_count), 1);
    for (int v = 0; v < topology.vertex_count; ++v) {
        if (!is_counted(v)) continue;
        const auto p = static_cast<std::size_t>(part_of_vertex[at(v)]);
        if (singular[p] * least_room <= quads[p]) continue;
        cost_factor[at(v)] *= increase;
        found = true;
    }
    return found;
}

/// What the deformation of the domain asks of crosses.
CrossFieldTargets make_targets(const Result& result) {
    CrossFieldTargetOptions options;
    options.method = result.options.field;
    options.alpha = *result.options.alpha;
    options.curvature_weight = result.options.curvature;
    options.edge_length = result.edge_length;
    return compute_cross_field_targets(result.domain.topology, result.domain.metric, result.tensors,
                                       options);
}

CrossField make_cross_field(const Result& result, const CrossFieldTargets& targets,
                            const Context& context) {
    CrossFieldOptions options;
    options.method = result.options.field;
    options.singularity_cost = *result.options.singularity_cost;
    options.edge_length = result.edge_length;
    if (result.domain.is_half()) options.mirror_edges = result.domain.curve_edges();
    options.feature_edges = result.domain.feature_edges;
    options.fixed_directions = result.domain.fixed_directions;
    options.avoided_vertices = result.domain.avoided_vertices;
    const auto solve = [&](const CrossFieldTargets& soft) {
        CrossField field = compute_cross_field(result.domain.topology, result.domain.metric, soft,
                                               options, context);
        require_valid_field(
            verify_cross_field(result.domain.topology, result.domain.metric, field, options));
        return field;
    };
    const bool is_symmetric = result.options.symmetry == SymmetryMode::field;
    const bool is_averaged =
        is_symmetric && result.options.symmetrisation == Symmetrisation::orbits;
    if (is_symmetric && !is_averaged) {
        options.symmetry = symmetry_term(result.symmetry->map, symmetry_weight);
    }
    CrossField field = solve(targets);
    constexpr int most_increases = 4;
    for (int i = 0; i < most_increases && options.method == CrossFieldMethod::convex; ++i) {
        if (!price_crowds(result.domain.topology, result.domain.metric, result.edge_length, field,
                          options.cost_factor))
            break;
        const auto singular = (field.index.array() != 0).count();
        CrossField fewer = solve(targets);
        const auto left = (fewer.index.array() != 0).count();
        if (left >= singular) break;
        context.write_log(LogLevel::info,
                          fmt::format("field: {} singularities instead of {}, as quads have no "
                                      "room for more",
                                      left, singular));
        field = std::move(fewer);
    }
    if (!is_averaged) return field;
    return solve(average_over_orbits(result.domain.topology, result.domain.metric, field,
                                     result.symmetry->map, orbit_weight(result.options), context));
}

void require_valid_map(const GridMap& map) {
    const GridMapReport report = verify_grid_map(map);
    if (report.valid()) return;
    throw VerificationError(fmt::format(
        "the grid map is not valid: {} flipped triangles, {} broken transitions, {} fractional "
        "translations, {} singularities off the grid, {} wrong cone angles, {} edges off their "
        "lines; please report this input",
        report.flipped_triangles, report.broken_transitions, report.fractional_translations,
        report.fractional_singularities, report.wrong_cone_angles, report.unaligned_edges));
}

/// Quads of a half without edges between two vertices of the stationary curve inside.
QuadMesh separate_from_curve(QuadMesh quads, const Domain& domain,
                             const std::vector<DomainView>& views) {
    std::vector<Positions> poses;
    poses.reserve(views.size());
    for (const DomainView& view : views) poses.push_back(view.reference);
    std::vector<char> is_on_curve = curve_vertices(quads, domain);
    return split_rows_across_curve(
        std::move(quads), std::move(is_on_curve),
        [&](const std::vector<SurfacePoint>& points, bool is_on_boundary) {
            return middle_point(domain.surface, domain.topology, poses, points, is_on_boundary);
        });
}

/// `quads`, on the triangles of `result.domain`, as points of the input.
QuadMesh on_input(QuadMesh quads, const Result& result) {
    for (SurfacePoint& point : quads.vertex) {
        point = point_of_input(result.domain.surface.mesh, point);
        if (result.refined) point = point_of_input(*result.refined, point);
    }
    return quads;
}

/// How far quads of a run are relaxed, where a frame of all its views has `vertex_count` vertices.
RelaxOptions relax_options(const Options& run, int vertex_count) {
    RelaxOptions options;
    options.rounds = run.relax_rounds;
    if (run.symmetry == SymmetryMode::none) return options;
    // Quads that serve both sides have farther to go than those of a map without symmetry. Of many
    // vertices there are fewer frames, so that memory stays within bounds.
    constexpr int most_frames = 24;
    constexpr int most_positions = 2'000'000;
    const int frames_in_bounds = most_positions / std::max(1, vertex_count);
    options.settling_frames = std::min(most_frames, frames_in_bounds);
    options.watched_frames = std::max(options.sampled_frames, frames_in_bounds);
    options.watched_rounds = 9 * run.relax_rounds / 2;
    const bool is_mirrored = run.symmetry == SymmetryMode::exact;
    options.rounds = run.relax_rounds * (is_mirrored ? 9 : 8) / 4;
    options.settling_rounds = run.relax_rounds * (is_mirrored ? 8 : 6) / 4;
    options.gap_limit = is_mirrored ? 0.46 : 0.43;
    // Mirrored quads gain nothing by it. docs/relaxation.md
    options.drags_patches = !is_mirrored && run.field == CrossFieldMethod::convex;
    return options;
}

/// What `relax`, `relax_quads` or `settle_in_more_frames`, makes of `quads` over `domain`,
/// verified; unless there is no relaxation.
QuadMesh slide_on_domain(decltype(relax_quads)& relax, const Domain& domain,
                         const std::vector<DomainView>& views,
                         const std::vector<int>& feature_edges, const QuadMesh& quads,
                         const Options& run, const Context& context) {
    if (run.relax_rounds == 0) return quads;
    RelaxOptions options =
        relax_options(run, static_cast<int>(views.size()) * domain.surface.mesh.vertex_count);
    options.reference_frame = is_single_pose(run) ? std::optional<int>(0)
                              : run.reference != Options::rest_shape
                                  ? std::optional<int>(run.reference)
                                  : std::nullopt;
    options.line_edges = domain.curve_edges();
    for (const std::vector<int>& lines : {boundary_edges(domain.topology), feature_edges}) {
        options.line_edges.insert(options.line_edges.end(), lines.begin(), lines.end());
    }
    std::vector<RelaxView> relax_views;
    relax_views.reserve(views.size());
    for (const DomainView& view : views) relax_views.push_back({view.frames, view.reference});
    QuadMesh relaxed = relax(quads, relax_views, domain.topology, domain.metric, options, context);
    require_valid(verify_quad_mesh(relaxed, domain.topology));
    return relaxed;
}

}  // namespace

IntrinsicMetric choose_metric(const FrameSource& frames, const Topology& topology,
                              const Positions& reference, MetricChoice choice,
                              const Context& context) {
    return widen_flat_triangles(topology, choice == MetricChoice::reference
                                              ? metric_of(topology, reference)
                                              : compute_mean_metric(frames, topology, context));
}

std::vector<int> feature_edges_of(const RefinedMesh& mesh, const Topology& topology,
                                  const Result& run) {
    return edges_along(topology, run.refined ? as_refinement_of_input(*run.refined, mesh) : mesh,
                       run.topology, run.features);
}

void measure_deformation(const std::vector<DomainView>& views, Result& result,
                         const Context& context, const StageEnd& finish_stage) {
    result.domain.feature_edges =
        feature_edges_of(result.domain.surface.mesh, result.domain.topology, result);
    result.tensors = sum_of_tensors(views, result, context);
    finish_stage("deformation");
}

void solve_field(Result& result, const Context& context,
                 const std::optional<CrossFieldTargets>& targets) {
    result.field = make_cross_field(result, targets ? *targets : make_targets(result), context);
}

QuadMesh map_and_extract(const std::vector<DomainView>& views, Result& result,
                         const Context& context, const StageEnd& finish_stage) {
    // Where the quads come out too coarse for the surface, such as two edges between the same two
    // vertices, map and quads are made again with shorter edges.
    constexpr int most_attempts = 5;
    constexpr double shortening = 0.8;
    const Domain& domain = result.domain;
    GridMapOptions options;
    options.edge_length = result.edge_length;
    if (!domain.is_half()) options.line_edges = domain.curve_edges();
    options.feature_edges = domain.feature_edges;
    for (int attempt = 1;; ++attempt) {
        try {
            result.map =
                compute_grid_map(domain.topology, domain.metric, result.field, options, context);
            require_valid_map(result.map);
            finish_stage("map");
            QuadMesh quads = extract_quads(result.map, context);
            if (domain.is_half()) quads = separate_from_curve(std::move(quads), domain, views);
            require_valid(verify_quad_mesh(quads, domain.topology));
            result.quads = on_input(quads, result);
            finish_stage("extraction");
            return quads;
        } catch (const Error& error) {
            const auto* no_map = dynamic_cast<const GridMapError*>(&error);
            const bool no_density_helps = no_map != nullptr && !no_map->depends_on_density();
            if (!may_be_overcome(error) || no_density_helps || attempt == most_attempts) throw;
            options.edge_length *= shortening;
            result.notes.push_back(fmt::format("edges of {:.4g} instead of {:.4g}: {}",
                                               options.edge_length, result.edge_length,
                                               error.what()));
            context.write_log(LogLevel::warning, "gridmap: " + result.notes.back());
        }
    }
}

bool may_be_overcome(const Error& error) {
    return error.code() == ExitCode::no_grid_map || error.code() == ExitCode::verification_failed;
}

QuadMesh relax_on_domain(const Domain& domain, const std::vector<DomainView>& views,
                         const std::vector<int>& feature_edges, const QuadMesh& quads,
                         const Options& run, const Context& context) {
    return slide_on_domain(relax_quads, domain, views, feature_edges, quads, run, context);
}

QuadMesh settle_on_domain(const Domain& domain, const std::vector<DomainView>& views,
                          const std::vector<int>& feature_edges, const QuadMesh& quads,
                          const Options& run, const Context& context) {
    return slide_on_domain(settle_in_more_frames, domain, views, feature_edges, quads, run,
                           context);
}

}  // namespace kinequad
