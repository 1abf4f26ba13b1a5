#include "kinequad/pipeline/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinequad/core/error.h"

namespace kinequad {
namespace {

/// What a recipe says of the cross field.
struct FieldRecipe {
    Symmetrisation symmetrisation;
    double alpha;
    double singularity_cost;
};

/// The recipes for `options` if these leave all to them. What serves both sides at once is a matter
/// of how differently they move.
std::vector<FieldRecipe> known_recipes(const Options& options) {
    using enum Symmetrisation;
    const bool is_paper = options.field == CrossFieldMethod::paper;
    if (options.symmetry == SymmetryMode::none || is_paper) {
        const bool is_half = options.symmetry == SymmetryMode::exact;
        return {{options.symmetrisation.value_or(is_paper && !is_half ? orbits : term),
                 default_alpha(options.field), is_half ? 0.1 : 0.08}};
    }
    if (options.symmetry == SymmetryMode::field) {
        return {{term, 0.05, 0.08}, {term, 0.1, 0.08},  {term, 0.35, 0.08},
                {orbits, 0.4, 0.2}, {orbits, 0.5, 0.2}, {orbits, 0.45, 0.12}};
    }
    return {{term, 0.02, 0.1},
            {term, 0.35, 0.1},
            {term, 0.5, 0.1},
            {orbits, 0.1, 0.1},
            {orbits, 0.35, 0.1}};
}

}  // namespace

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
    std::vector<Options> recipes;
    for (const FieldRecipe& known : known_recipes(options)) {
        if (known.symmetrisation != options.symmetrisation.value_or(known.symmetrisation)) continue;
        Options recipe = options;
        recipe.symmetrisation = known.symmetrisation;
        recipe.alpha = options.alpha.value_or(known.alpha);
        recipe.singularity_cost = options.singularity_cost.value_or(known.singularity_cost);
        // What is given may leave no difference; with an alpha there is one recipe for each way.
        const bool is_listed = std::any_of(recipes.begin(), recipes.end(), [&](const Options& r) {
            return r.symmetrisation == recipe.symmetrisation && r.alpha == recipe.alpha &&
                   (options.alpha || r.singularity_cost == recipe.singularity_cost);
        });
        if (!is_listed) recipes.push_back(std::move(recipe));
    }
    return recipes;
}

}  // namespace kinequad
