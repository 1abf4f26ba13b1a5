#include "kinequad/pipeline/quadrangulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "kinequad/core/error.h"
#include "kinequad/deformation/compute_mean_metric.h"
#include "kinequad/extract/mirrored_quads.h"
#include "kinequad/extract/verify_quad_mesh.h"
#include "kinequad/gridmap/compute_grid_map.h"
#include "kinequad/field/refine_cross_field.h"
#include "kinequad/field/symmetrise_field.h"
#include "kinequad/io/memory_sequence.h"
#include "kinequad/mesh/feature_edges.h"
#include "kinequad/mesh/split_along_level.h"
#include "kinequad/mesh/widen_flat_triangles.h"
#include "kinequad/pipeline/check_input.h"
#include "kinequad/pipeline/refine_coarse_input.h"
#include "kinequad/pipeline/solve_quads.h"
#include "kinequad/relax/relax_quads.h"
#include "kinequad/symmetry/even_out_half.h"
#include "kinequad/transfer/carried_sequence.h"

namespace kinequad {
namespace {

Positions read_reference_frame(const FrameSource& source, int reference) {
    return reference == Options::rest_shape ? source.read_rest_shape()
                                            : source.read_frame(reference);
}

/// The lengths that a surface is known by.
IntrinsicMetric choose_metric(const FrameSource& frames, const Topology& topology,
                              const Positions& reference, const Options& options,
                              const Context& context) {
    return widen_flat_triangles(topology, options.metric == MetricChoice::reference
                                              ? metric_of(topology, reference)
                                              : compute_mean_metric(frames, topology, context));
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

constexpr int largest_evening_rounds = 8;
/// Share of an edge within which vertices come to lie on the stationary curve.
constexpr double curve_snap_share = 0.2;

/// Shapes in which the two sides are matched: the reference and some frames, evenly chosen.
std::vector<Positions> matching_shapes(const FrameSource& frames, const Positions& reference) {
    constexpr int largest_count = 8;
    std::vector<Positions> shapes = {reference};
    const int count = std::min(largest_count, frames.frame_count());
    for (int i = 1; i < count; ++i) {
        shapes.push_back(frames.read_frame(i * frames.frame_count() / count));
    }
    return shapes;
}

/// Directions of the stationary curve in the triangles of the surface that the edges of the curve
/// touch once it is inserted: smoothed where the map has them, else those of the edges.
std::vector<FixedDirection> curve_directions(const LevelSplit& split, const Topology& topology,
                                             const IntrinsicMetric& metric,
                                             const SymmetryMap& map) {
    std::vector<FixedDirection> directions;
    std::vector<int> known(static_cast<std::size_t>(topology.triangle_count), 0);
    for (const StationaryDirection& crossed : map.stationary_direction) {
        known[static_cast<std::size_t>(crossed.triangle)] = 1;
    }
    std::vector<int> is_wanted(known.size(), 0);
    for (Eigen::Index corner = 0; corner < split.mesh.F.size(); ++corner) {
        const Eigen::Index next = corner % 3 == 2 ? corner - 2 : corner + 1;
        const auto on_curve = [&](Eigen::Index c) {
            return split.is_on_level[static_cast<std::size_t>(split.mesh.F.data()[c])] != 0;
        };
        if (!on_curve(corner) || !on_curve(next)) continue;
        const int t = split.mesh.parent[static_cast<std::size_t>(corner / 3)];
        int& wanted = is_wanted[static_cast<std::size_t>(t)];
        if (wanted || known[static_cast<std::size_t>(t)]) {
            wanted = 1;
            continue;
        }
        wanted = 1;
        const Vector2 along = lay_out_triangle(side_lengths(topology, metric, t)) *
                              (split.mesh.barycentric.row(next) -
                               split.mesh.barycentric.row(corner))
                                  .transpose();
        directions.push_back({t, std::atan2(along[1], along[0])});
    }
    for (const StationaryDirection& crossed : map.stationary_direction) {
        if (is_wanted[static_cast<std::size_t>(crossed.triangle)]) {
            directions.push_back({crossed.triangle, crossed.angle});
        }
    }
    return directions;
}

/// The quads of both sides, from those of the half.
QuadMesh mirror_quads(const FrameSource& frames, const Topology& topology,
                      const IntrinsicMetric& metric, const Positions& reference,
                      const Result& result, const QuadMesh& half, const Context& context) {
    const SymmetricHalf& surface = result.domain.surface;
    const std::vector<SurfacePoint> mirrored =
        mirror_points(surface, topology, metric, frames.triangles(),
                      matching_shapes(frames, reference), half.vertex, context);
    QuadMesh on_whole{half.Q, {}, {}};
    for (const SurfacePoint& point : half.vertex) {
        on_whole.vertex.push_back(point_of_input(surface.mesh, point));
    }
    const std::vector<char> is_on_curve = curve_vertices(half, result.domain);
    QuadMesh whole = join_mirrored_quads(on_whole, mirrored, is_on_curve);
    if (result.options.relax_rounds > 0) {
        // Where the surface is finer than the map is straight, mirrored quads can still fold.
        RelaxOptions options;
        options.rounds = 0;
        options.pinned.assign(whole.vertex.size(), 0);
        std::fill_n(options.pinned.begin(), half.vertex.size(), 1);
        whole.vertex = relax_quads(whole, {{frames, reference}}, topology,
                                   metric_of(topology, reference), options, context)
                           .vertex;
    }
    const MirrorReport report = verify_mirror(whole);
    if (!report.valid()) {
        throw VerificationError(fmt::format(
            "the quads are not their own mirror image: {} vertices, {} quads and {} vertices on "
            "the line of symmetry do not fit; please report this input",
            report.broken_vertices, report.broken_quads, report.loose_fixed_vertices));
    }
    return whole;
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
    // A symmetry map is made of the input as it is: seams would not fit where both sides are cut.
    if (result.options.symmetry == SymmetryMode::none) result.refined =
        refine_coarse_input(result.topology, result.reference, result.options, context);
    finish_stage("check");

    // From here on the surface is the refined one, up to the finished quads.
    std::optional<CarriedSequence> finer;
    if (result.refined) finer.emplace(source, result.refined->F, vertex_points(*result.refined));
    const FrameSource& surface = finer ? static_cast<const FrameSource&>(*finer) : source;
    const Positions reference = finer ? finer->carry(result.reference) : result.reference;
    const Topology topology =
        finer ? build_topology(surface.triangles(), surface.vertex_count()) : result.topology;

    // A run on a single pose sees the reference as if it were the whole sequence.
    std::optional<MemorySequence> pose;
    if (is_single_pose(result.options)) {
        pose.emplace(surface.triangles(), std::vector<Positions>{reference}, std::nullopt,
                     surface.name());
    }
    const FrameSource& frames = pose ? *pose : surface;
    const IntrinsicMetric metric =
        choose_metric(frames, topology, reference, result.options, context);
    check_areas(source, topology, metric);
    result.edge_length = result.options.edge_length > 0
                             ? result.options.edge_length
                             : edge_length_for(topology, metric, result.options.vertices);
    result.domain.surface.mesh = as_refined_mesh(surface.triangles(), surface.vertex_count());
    result.domain.surface.is_on_curve.assign(static_cast<std::size_t>(surface.vertex_count()), 0);
    result.domain.topology = topology;
    result.domain.metric = metric;
    finish_stage("metric");

    if (result.options.symmetry == SymmetryMode::none) {
        const std::vector<DomainView> views = {{frames, reference, metric}};
        solve_field(views, result, context, finish_stage);
        result.quads = solve_quads(views, result, context, finish_stage);
        put_on_input(result);
        note_density(result, context);
        finish_stage("relaxation");
        return result;
    }

    result.symmetry = find_symmetry(frames, metric, landmarks, reference, context);
    if (result.options.symmetry == SymmetryMode::field) {
        const LevelSplit split =
            split_along_level(topology, metric, result.symmetry->map.height, curve_snap_share);
        result.domain.fixed_directions =
            curve_directions(split, topology, metric, result.symmetry->map);
        for (const FixedDirection& fixed : result.domain.fixed_directions) {
            for (int k = 0; k < 3; ++k) {
                result.domain.avoided_vertices.push_back(surface.triangles()(fixed.triangle, k));
            }
        }
        finish_stage("symmetry");
        solve_field({{frames, reference, metric}}, result, context, finish_stage);
        Domain whole;
        whole.surface.mesh = split.mesh;
        whole.surface.is_on_curve = split.is_on_level;
        whole.topology = build_topology(split.mesh.F, split.mesh.vertex_count);
        const CarriedSequence cut(frames, split.mesh.F, vertex_points(split.mesh));
        Positions pose = cut.carry(reference);
        whole.metric = choose_metric(cut, whole.topology, pose, result.options, context);
        if (result.options.feature_angle > 0) {
            whole.feature_edges =
                find_feature_edges(whole.topology, pose, result.options.feature_angle);
        }
        const CrossField before = result.field;
        result.field = refine_cross_field(result.field, topology, metric, split.mesh,
                                          whole.topology, whole.metric);
        if (std::getenv("DBG")) {
            for (int v = 0; v < whole.topology.vertex_count; ++v) {
                if (result.field.index[v] && split.is_on_level[v]) fmt::print("on curve {} index {}\n", v, result.field.index[v]);
            }
            const FieldSymmetry fs = measure_field_symmetry(topology, metric, before, result.symmetry->map, reference, surface.triangles(), 3 * result.edge_length);
            fmt::print("field symmetry {:.3f} degrees, {} of {} partnered\n", fs.mean_degrees, fs.partnered, fs.singularities);
        }
        result.domain = std::move(whole);
        result.quads = solve_quads({{cut, std::move(pose), result.domain.metric}}, result, context,
                                   finish_stage);
        for (SurfacePoint& point : result.quads.vertex) point = point_of_input(split.mesh, point);
        require_valid(verify_quad_mesh(result.quads, topology));
        put_on_input(result);
        note_density(result, context);
        finish_stage("relaxation");
        return result;
    }
    SymmetricHalf& half = result.domain.surface;
    half =
        take_symmetric_half(topology, metric, result.symmetry->map, reference, surface.triangles());
    result.domain.topology = build_topology(half.mesh.F, half.mesh.vertex_count);
    const CarriedSequence near(frames, half.mesh.F, vertex_points(half.mesh));
    half.mirrored = even_out_half(
        half,
        choose_metric(near, result.domain.topology, near.carry(reference), result.options, context),
        topology, metric, largest_evening_rounds, context);
    const CarriedSequence far(frames, half.mesh.F, half.mirrored, true);
    std::vector<DomainView> views;
    for (const CarriedSequence* side : {&near, &far}) {
        Positions pose = side->carry(reference);
        IntrinsicMetric lengths =
            choose_metric(*side, result.domain.topology, pose, result.options, context);
        views.push_back({*side, std::move(pose), std::move(lengths)});
    }
    result.domain.metric.edge_length =
        (views[0].metric.edge_length + views[1].metric.edge_length) / 2;
    finish_stage("symmetry");

    solve_field(views, result, context, finish_stage);
    const QuadMesh quads = solve_quads(views, result, context, finish_stage);
    result.quads = mirror_quads(frames, topology, metric, reference, result, quads, context);
    put_on_input(result);
    note_density(result, context);
    require_valid(verify_quad_mesh(result.quads, result.topology));
    finish_stage("relaxation");
    return result;
}

}  // namespace kinequad
