#include "kinequad/pipeline/options.h"

#include <fmt/format.h>

#include <cmath>

#include "kinequad/core/error.h"

namespace kinequad {

Options resolve_options(Options options, int frame_count, bool has_rest_shape, bool has_landmarks) {
    const auto check = [](bool condition, const std::string& message) {
        require(condition, InputFault::usage, message);
    };
    if (!options.symmetry) {
        // The paper makes the field alone symmetric.
        options.symmetry = !has_landmarks                             ? SymmetryMode::none
                           : options.field == CrossFieldMethod::paper ? SymmetryMode::field
                                                                      : SymmetryMode::exact;
    }
    check(options.field != CrossFieldMethod::paper || options.symmetry != SymmetryMode::field ||
              options.symmetrisation.value_or(Symmetrisation::orbits) == Symmetrisation::orbits,
          "--symmetrise term: needs --field convex; the paper averages over orbits");
    const double alpha = options.alpha.value_or(default_alpha(options.field));
    if (!options.metric) {
        options.metric = alpha == 0 || options.field == CrossFieldMethod::paper
                             ? MetricChoice::reference
                             : MetricChoice::mean;
    }
    // Written so that a NaN fails.
    check(alpha >= 0 && alpha < 1,
          fmt::format("--alpha {}: has to be at least 0 and below 1", alpha));
    check(std::isfinite(options.edge_length) && options.edge_length >= 0,
          fmt::format("--edge-length {}: has to be positive, or 0 to go by --vertices",
                      options.edge_length));
    check(options.edge_length > 0 || (options.vertices >= 8 && options.vertices <= 100'000'000),
          fmt::format("--vertices {}: has to be between 8 and 100000000", options.vertices));
    check(std::isfinite(options.curvature) && options.curvature >= 0,
          fmt::format("--curvature {}: has to be at least 0", options.curvature));
    const double cost = options.singularity_cost.value_or(0);
    check(std::isfinite(cost) && cost >= 0,
          fmt::format("--singularity-cost {}: has to be at least 0", cost));
    check(options.feature_angle >= 0 && options.feature_angle <= 180,
          fmt::format("--feature-angle {}: has to be between 0 and 180 degrees",
                      options.feature_angle));
    check(options.relax_rounds >= 0 && options.relax_rounds <= 10'000,
          fmt::format("--relax {}: has to be between 0 and 10000", options.relax_rounds));
    if (options.reference == Options::rest_shape) {
        check(has_rest_shape, "--reference rest: the input has no rest shape; name a frame");
    } else {
        check(options.reference >= 0 && options.reference < frame_count,
              fmt::format("--reference {}: the input has frames 0 to {}", options.reference,
                          frame_count - 1));
    }
    return options;
}

std::vector<Options> list_recipes(const Options& options) {
    const bool is_paper = options.field == CrossFieldMethod::paper;
    const bool is_whole = options.symmetry == SymmetryMode::field;
    const bool is_half = options.symmetry == SymmetryMode::exact;
    std::vector<Symmetrisation> symmetrisations = {options.symmetrisation.value_or(
        is_paper && !is_half ? Symmetrisation::orbits : Symmetrisation::term)};
    if ((is_whole || is_half) && !is_paper && !options.symmetrisation) {
        symmetrisations.push_back(Symmetrisation::orbits);
    }
    std::vector<Options> recipes;
    for (const Symmetrisation symmetrisation : symmetrisations) {
        const bool is_averaged = symmetrisation == Symmetrisation::orbits;
        std::vector<double> alphas = {default_alpha(options.field)};
        // What serves both sides at once is a matter of how differently they move.
        if (!is_paper && options.symmetry != SymmetryMode::none) {
            if (is_whole)
                alphas = is_averaged ? std::vector{0.4, 0.5} : std::vector{0.05, 0.1, 0.35};
            if (is_half) {
                alphas = is_averaged ? std::vector{0.1, 0.35} : std::vector{0.02, 0.35, 0.5};
            }
        }
        if (options.alpha) alphas = {*options.alpha};
        const double cost = is_half ? 0.1 : is_whole && is_averaged ? 0.2 : 0.08;
        for (const double alpha : alphas) {
            Options recipe = options;
            recipe.symmetrisation = symmetrisation;
            recipe.alpha = alpha;
            recipe.singularity_cost = options.singularity_cost.value_or(cost);
            recipes.push_back(recipe);
        }
    }
    return recipes;
}

}  // namespace kinequad
