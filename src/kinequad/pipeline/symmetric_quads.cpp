#include "kinequad/pipeline/symmetric_quads.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/extract/mirrored_quads.h"
#include "kinequad/field/refine_cross_field.h"
#include "kinequad/mesh/split_along_level.h"
#include "kinequad/pipeline/best_recipe.h"
#include "kinequad/pipeline/solve_quads.h"
#include "kinequad/relax/relax_quads.h"
#include "kinequad/symmetry/even_out_half.h"
#include "kinequad/symmetry/fair_stationary_curve.h"
#include "kinequad/symmetry/verify_symmetry_map.h"
#include "kinequad/transfer/carried_sequence.h"

namespace kinequad {
namespace {

constexpr int largest_evening_rounds = 8;

/// The frame that is the reference among those that the run sees; -1 where it is none of them.
int reference_frame_of(const Options& run) {
    if (is_single_pose(run)) return 0;
    return run.reference == Options::rest_shape ? -1 : run.reference;
}

/// Shapes in which the two sides are matched: the reference, which is frame `reference_frame` if
/// any, and some other frames, evenly chosen.
std::vector<Positions> matching_shapes(const FrameSource& frames, const Positions& reference,
                                       int reference_frame) {
    constexpr int largest_count = 8;
    std::vector<Positions> shapes = {reference};
    for (const int frame : evenly_chosen_frames(frames.frame_count(), largest_count)) {
        if (frame != reference_frame) shapes.push_back(frames.read_frame(frame));
    }
    return shapes;
}

/// Directions of the stationary curve in the triangles of the surface that the edges of the curve
/// touch once it is inserted: smoothed where the map has them, else those of the edges.
std::vector<FixedDirection> curve_directions(const LevelSplit& split, const Topology& topology,
                                             const IntrinsicMetric& metric,
                                             const SymmetryMap& map) {
    std::vector<FixedDirection> directions;
    std::vector<int> known(at(topology.triangle_count), 0);
    for (const StationaryDirection& crossed : map.stationary_direction) {
        known[at(crossed.triangle)] = 1;
    }
    std::vector<int> is_wanted(known.size(), 0);
    for (Eigen::Index corner = 0; corner < split.mesh.F.size(); ++corner) {
        const Eigen::Index next = corner % 3 == 2 ? corner - 2 : corner + 1;
        const auto on_curve = [&](Eigen::Index c) {
            return split.is_on_level[at(split.mesh.F.data()[c])] != 0;
        };
        if (!on_curve(corner) || !on_curve(next)) continue;
        const int t = split.mesh.parent[at(corner / 3)];
        int& wanted = is_wanted[at(t)];
        if (wanted || known[at(t)]) {
            wanted = 1;
            continue;
        }
        wanted = 1;
        const Vector2 along =
            lay_out_triangle(side_lengths(topology, metric, t)) *
            (split.mesh.barycentric.row(next) - split.mesh.barycentric.row(corner)).transpose();
        directions.push_back({t, std::atan2(along[1], along[0])});
    }
    for (const StationaryDirection& crossed : map.stationary_direction) {
        if (is_wanted[at(crossed.triangle)]) {
            directions.push_back({crossed.triangle, crossed.angle});
        }
    }
    return directions;
}

/// Whether two views are the same but for rigid motions and mirrors, as those of a surface that
/// mirrors in space: by their edge lengths in the poses that the sides are matched in.
bool are_alike(const DomainView& one, const DomainView& other, const Topology& topology,
               int reference_frame) {
    constexpr double tolerance = 1e-6;
    const auto shapes = matching_shapes(one.frames, one.reference, reference_frame);
    const auto others = matching_shapes(other.frames, other.reference, reference_frame);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        const Eigen::VectorXd lengths = metric_of(topology, shapes[i]).edge_length;
        const Eigen::VectorXd there = metric_of(topology, others[i]).edge_length;
        if ((lengths - there).norm() > tolerance * lengths.norm()) return false;
    }
    return true;
}

/// Makes crosses of the whole surface keep to the stationary curve of `map`, which `split` has
/// inserted, and singularities keep away from it.
void keep_to_curve(Domain& domain, const LevelSplit& split, const SymmetryMap& map,
                   const Triangles& F) {
    domain.fixed_directions = curve_directions(split, domain.topology, domain.metric, map);
    for (const FixedDirection& fixed : domain.fixed_directions) {
        for (int k = 0; k < 3; ++k) domain.avoided_vertices.push_back(F(fixed.triangle, k));
    }
}

/// The deformation of the whole surface of a run that solves one half, for its field.
Result measure_whole(const SolvedSurface& surface, const Result& run, const Context& context) {
    Result whole;
    whole.edge_length = run.edge_length;
    whole.topology = run.topology;
    whole.features = run.features;
    whole.refined = run.refined;
    whole.domain.surface.mesh =
        as_refined_mesh(surface.frames.triangles(), surface.frames.vertex_count());
    whole.domain.topology = surface.topology;
    whole.domain.metric = surface.metric;
    const SymmetryMap& map = run.symmetry->map;
    keep_to_curve(whole.domain, insert_stationary_curve(surface.topology, surface.metric, map), map,
                  surface.frames.triangles());
    measure_deformation({{surface.frames, surface.reference, surface.metric}}, whole, context,
                        [](const char*) {});
    return whole;
}

/// What the crosses of a half are drawn to by the field of the whole surface, solved first and
/// averaged over the orbits of `map`.
CrossFieldTargets targets_from_whole(Result& whole, const Options& recipe, const SymmetryMap& map,
                                     const SymmetricHalf& half, const Context& context) {
    constexpr double weight = 0.1;
    whole.options = recipe;
    whole.options.symmetry = SymmetryMode::none;
    solve_field(whole, context);
    return refine_targets(average_over_orbits(whole.domain.topology, whole.domain.metric,
                                              whole.field, map, weight, context),
                          whole.domain.topology, whole.domain.metric, half.mesh);
}

/// The surface with the stationary curve inserted.
class CutSurface {
public:
    CutSurface(const SolvedSurface& surface, const LevelSplit& split, const Result& run,
               const Context& context)
        : frames_(surface.frames, split.mesh.F, vertex_points(split.mesh)),
          reference_(frames_.carry(surface.reference)) {
        domain_.surface.mesh = split.mesh;
        domain_.surface.is_on_curve = split.is_on_level;
        domain_.topology = build_topology(split.mesh.F, split.mesh.vertex_count);
        domain_.metric =
            choose_metric(frames_, domain_.topology, reference_, *run.options.metric, context);
        domain_.feature_edges = feature_edges_of(split.mesh, domain_.topology, run);
    }

    const Domain& domain() const { return domain_; }
    DomainView view() const { return {frames_, reference_, domain_.metric}; }

private:
    CarriedSequence frames_;
    Positions reference_;
    Domain domain_;
};

/// Throws `VerificationError` where a vertex of quads on the surface with the curve inserted is its
/// own mirror image and not on an edge of the curve, along which it could slide.
void require_on_curve(const QuadMesh& quads, const LevelSplit& split) {
    for (std::size_t v = 0; v < quads.vertex.size(); ++v) {
        if (quads.mirror[v] != static_cast<int>(v)) continue;
        const SurfacePoint& point = quads.vertex[v];
        for (int k = 0; k < 3; ++k) {
            if (point.barycentric[k] == 0 || split.is_on_level[at(split.mesh.F(point.triangle, k))])
                continue;
            throw VerificationError(fmt::format(
                "vertex {} of the line of symmetry is not on it; please report this input", v));
        }
    }
}

/// The quads of both sides, from those of the `half` solved, relaxed unless the sides `are_tied`,
/// as where they are alike: each finds its own place on the surface.
QuadMesh mirror_quads(const SolvedSurface& surface, const Result& result,
                      const SolvedRecipe& solved, const QuadMesh& half, bool are_tied,
                      const Context& context) {
    const FrameSource& frames = surface.frames;
    const Topology& topology = surface.topology;
    const IntrinsicMetric& metric = surface.metric;
    const Positions& reference = surface.reference;
    const SymmetricHalf& side = solved.domain.surface;
    const std::vector<SurfacePoint> mirrored =
        mirror_points(side, topology, metric, frames.triangles(),
                      matching_shapes(frames, reference, reference_frame_of(solved.options)),
                      half.vertex, context);
    QuadMesh on_whole{half.Q, {}, {}};
    for (const SurfacePoint& point : half.vertex) {
        on_whole.vertex.push_back(point_of_input(side.mesh, point));
    }
    const std::vector<char> is_on_curve = curve_vertices(half, solved.domain);
    QuadMesh whole = join_mirrored_quads(on_whole, mirrored, is_on_curve);
    if (!are_tied) {
        const LevelSplit split = insert_stationary_curve(topology, metric, result.symmetry->map);
        const CutSurface cut(surface, split, result, context);
        const RefinementSearch search(split.mesh);
        for (SurfacePoint& point : whole.vertex) point = search.find(point);
        require_on_curve(whole, split);
        whole.vertex = relax_on_domain(cut.domain(), {cut.view()}, cut.domain().feature_edges,
                                       whole, solved.options, context)
                           .vertex;
        for (SurfacePoint& point : whole.vertex) point = point_of_input(split.mesh, point);
    }
    return whole;
}

/// Checks that quads are their own mirror image, and measures how far they are from the map's.
MirrorQuality judge_mirror(const SolvedSurface& surface, const SymmetryMap& map,
                           const QuadMesh& quads) {
    const TriangleMesh mesh{surface.reference, surface.frames.triangles()};
    MirrorQuality quality{verify_mirror(quads)};
    const MirrorReport& report = quality.report;
    if (!report.valid()) {
        throw VerificationError(fmt::format(
            "the quads are not their own mirror image: {} vertices, {} quads and {} vertices on "
            "the line of symmetry do not fit; please report this input",
            report.broken_vertices, report.broken_quads, report.loose_fixed_vertices));
    }
    const double percent = 100 / bounding_box_diagonal(mesh.V);
    for (std::size_t v = 0; v < quads.vertex.size(); ++v) {
        const Vector3 image = image_position(mesh, map.vertex_image, quads.vertex[v]);
        const Vector3 mirror = position_of(quads.vertex[at(quads.mirror[v])], mesh.V, mesh.F);
        const double distance = percent * (mirror - image).norm();
        quality.mean_distance_percent += distance / static_cast<double>(quads.vertex.size());
        quality.largest_distance_percent = std::max(quality.largest_distance_percent, distance);
    }
    return quality;
}

/// The quads of a symmetric field, with a chain of edges along the stationary curve of `line`, a
/// map like that of the run. Throws `GridMapError` where there are none, or, with the shortest
/// edges for a unit, none of the wanted number.
QuadMesh solve_along(const SymmetryMap& line, SnapUnit unit, const SolvedSurface& surface,
                     Result& result, const Context& context, const StageEnd& finish_stage) {
    const FrameSource& frames = surface.frames;
    const Topology& topology = surface.topology;
    const IntrinsicMetric& metric = surface.metric;
    const Positions& reference = surface.reference;
    const SymmetryMap& map = result.symmetry->map;
    const LevelSplit split = insert_stationary_curve(topology, metric, line, unit);
    keep_to_curve(result.domain, split, line, frames.triangles());
    finish_stage("symmetry");
    measure_deformation({{frames, reference, metric}}, result, context, finish_stage);

    // The map is made over the surface with the curve inserted.
    const CutSurface cut(surface, split, result, context);
    const std::vector<DomainView> views = {cut.view()};
    const auto solve = [&] {
        solve_field(result, context);
        result.field_symmetry =
            measure_field_symmetry(topology, metric, result.field, map, reference,
                                   frames.triangles(), 3 * result.edge_length);
        result.field = refine_cross_field(result.field, topology, metric, split.mesh,
                                          cut.domain().topology, cut.domain().metric);
        result.domain = cut.domain();
        finish_stage("field");
        return map_and_extract(views, result, context, finish_stage);
    };
    const auto finish = [&](const SolvedRecipe& solved, const Context& own) {
        if (unit == SnapUnit::shortest_edge && misses_wanted_count(solved)) {
            throw GridMapError("parts have no room for the line between their vertices");
        }
        QuadMesh quads = relax_on_domain(solved.domain, views, solved.map.feature_edges,
                                         solved.quads, solved.options, own);
        for (SurfacePoint& point : quads.vertex) point = point_of_input(split.mesh, point);
        return quads;
    };
    // The two ways to symmetry come out about as good as each other before relaxation.
    QuadMesh quads = finish_best_recipe(frames, reference, views, result, {solve, finish, 3},
                                        context, finish_stage);
    // The paper's method goes without.
    if (result.options.field == CrossFieldMethod::paper) return quads;
    const RefinementSearch search(split.mesh);
    for (SurfacePoint& point : quads.vertex) point = search.find(point);
    quads = settle_on_domain(cut.domain(), views, result.map.feature_edges, quads, result.options,
                             context);
    for (SurfacePoint& point : quads.vertex) point = point_of_input(split.mesh, point);
    return quads;
}

}  // namespace

QuadMesh solve_symmetric_field(const SolvedSurface& surface, Result& result, const Context& context,
                               const StageEnd& finish_stage) {
    const SymmetryMap& map = result.symmetry->map;
    const auto solve = [&](const SymmetryMap& line, SnapUnit unit) {
        return solve_along(line, unit, surface, result, context, finish_stage);
    };
    if (result.options.field == CrossFieldMethod::paper) return solve(map, SnapUnit::crossed_edge);
    // A line of quads runs along the curve: neither needles nor long triangles must bend it.
    constexpr double fairing_share = 0.25;
    const SymmetryMap faired = fair_stationary_curve(map, surface.topology, surface.metric,
                                                     fairing_share * result.edge_length);
    const Options options = result.options;
    const Domain domain = result.domain;
    try {
        return solve(faired, SnapUnit::shortest_edge);
    } catch (const GridMapError& error) {
        context.write_log(
            LogLevel::info,
            fmt::format("symmetry: {}; drawing the line to more vertices", error.what()));
    }
    result.options = options;
    result.domain = domain;
    result.notes.clear();
    return solve(map, SnapUnit::crossed_edge);
}

QuadMesh solve_mirrored_half(const SolvedSurface& surface, Result& result, const Context& context,
                             const StageEnd& finish_stage) {
    const FrameSource& frames = surface.frames;
    const Topology& topology = surface.topology;
    const IntrinsicMetric& metric = surface.metric;
    const Positions& reference = surface.reference;
    SymmetricHalf& half = result.domain.surface;
    half =
        take_symmetric_half(topology, metric, result.symmetry->map, reference, frames.triangles());
    const Topology half_topology = build_topology(half.mesh.F, half.mesh.vertex_count);
    const auto length_of = [&](const CarriedSequence& side) {
        return choose_metric(side, half_topology, side.carry(reference), *result.options.metric,
                             context);
    };
    const CarriedSequence near(frames, half.mesh.F, vertex_points(half.mesh));
    const IntrinsicMetric near_metric = length_of(near);
    half.mirrored =
        even_out_half(half, near_metric, topology, metric, largest_evening_rounds, context);
    const CarriedSequence far(frames, half.mesh.F, half.mirrored, true);
    const std::vector<DomainView> views = {{near, near.carry(reference), near_metric},
                                           {far, far.carry(reference), length_of(far)}};
    result.domain.topology = half_topology;
    result.domain.metric.edge_length =
        (views[0].metric.edge_length + views[1].metric.edge_length) / 2;
    finish_stage("symmetry");

    std::optional<Result> whole;
    measure_deformation(views, result, context, finish_stage);
    const auto solve = [&] {
        std::optional<CrossFieldTargets> targets;
        if (result.options.symmetrisation == Symmetrisation::orbits) {
            if (!whole) whole = measure_whole(surface, result, context);
            targets = targets_from_whole(*whole, result.options, result.symmetry->map,
                                         result.domain.surface, context);
        }
        solve_field(result, context, targets);
        finish_stage("field");
        return map_and_extract(views, result, context, finish_stage);
    };
    const bool are_tied =
        are_alike(views[0], views[1], half_topology, reference_frame_of(result.options));
    const auto finish = [&](const SolvedRecipe& solved, const Context& own) {
        const QuadMesh half_quads =
            are_tied ? relax_on_domain(solved.domain, views, solved.map.feature_edges, solved.quads,
                                       solved.options, own)
                     : solved.quads;
        return mirror_quads(surface, result, solved, half_quads, are_tied, own);
    };
    QuadMesh quads = finish_best_recipe(frames, reference, views, result, {solve, finish, 1},
                                        context, finish_stage);
    result.mirror = judge_mirror(surface, result.symmetry->map, quads);
    return quads;
}

}  // namespace kinequad
