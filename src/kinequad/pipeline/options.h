#pragma once

#include <array>
#include <optional>
#include <vector>

#include "kinequad/field/cross_field_method.h"

namespace kinequad {

/// How the quad mesh is made symmetric.
enum class SymmetryMode {
    none,   ///< symmetry of the shape is not used
    field,  ///< the cross field is drawn to be symmetric
    exact,  ///< one half is solved and mirrored: the connectivity is its own mirror image
};

/// How a cross field is made symmetric. docs/symmetry.md
enum class Symmetrisation {
    /// Solved on the whole surface, averaged over orbits, and solved again towards the average [Du
    /// and Tu]: on all of it, or on one half.
    orbits,
    /// Solved once: with a symmetry term in the energy, or on one half with what both sides do.
    term,
};

/// Edge lengths that the surface is known by up to the grid map. docs/pipeline.md
enum class MetricChoice {
    mean,       ///< averaged over all frames
    reference,  ///< of the reference frame
};

/// Everything that a run can be told. Each field is an option of the command line and of run.json.
struct Options {
    /// `reference` for the rest shape that comes beside a point cache.
    static constexpr int rest_shape = -1;

    /// Empty: where there are landmarks `exact`, or `field` with the paper's field; else `none`.
    std::optional<SymmetryMode> symmetry;
    /// Wanted number of quad vertices, met within 5 % where the surface lets it be.
    int vertices = 5200;
    double edge_length = 0;  ///< wanted quad edge length in units of the input; 0: from `vertices`
    /// Recipe of the cross field; `paper` is the energy and solver of Du and Tu.
    CrossFieldMethod field = CrossFieldMethod::convex;
    /// Empty: `orbits` with the paper's field and the symmetry `field`, else what is better for the
    /// input.
    std::optional<Symmetrisation> symmetrisation;
    /// Influence of the animation on the cross field; empty: what was measured best with `field`,
    /// and with symmetry what is best for the input. With 0 the run sees a single pose, the
    /// reference frame.
    std::optional<double> alpha;
    double curvature = 0.1;  ///< influence of the curvature on the cross field (`convex` only)
    /// Edges across which the reference frame turns by more than this are features, which become
    /// chains of quad edges, in degrees; 0: none.
    double feature_angle = 0;
    /// Further features: pairs of vertices of the input that an edge joins.
    std::vector<std::array<int, 2>> features = {};
    /// Energy that a singularity may cost, in rad^2 (`convex` only); empty: what was measured best
    /// with `symmetry` and `symmetrisation`.
    std::optional<double> singularity_cost;
    /// Empty: `mean`, and `reference` where `alpha` is 0, with the paper's field, or where quads
    /// for the mean would shear the reference for little (without symmetry, `convex` only).
    std::optional<MetricChoice> metric;
    int reference = 0;     ///< frame that is the reference, or `rest_shape`
    int relax_rounds = 8;  ///< passes in which vertices slide towards squares; 0: none
    bool metrics = true;   ///< measure the result in every frame
};

/// True where the run sees the reference frame only: no influence of the animation and its metric.
/// For options whose empty fields have been filled in.
inline bool is_single_pose(const Options& options) {
    return options.alpha == 0.0 && options.metric == MetricChoice::reference;
}

/// `options` with empty fields filled in by their defaults, for an input with or without landmarks,
/// but for those of the cross field that `list_recipes` leaves to the input. Throws `InputError`
/// (usage) where a value is out of its range, `reference` for `frame_count` frames and
/// `has_rest_shape`.
Options resolve_options(Options options, int frame_count, bool has_rest_shape, bool has_landmarks);

/// The ways to solve the cross field that are worth a try where `options`, resolved, leave a
/// choice: `options` with all empty fields filled in, at least once. docs/pipeline.md
std::vector<Options> list_recipes(const Options& options);

}  // namespace kinequad
