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
        options.symmetry = has_landmarks ? SymmetryMode::exact : SymmetryMode::none;
    }
    const bool is_paper = options.field == CrossFieldMethod::paper;
    if (!options.symmetrisation) {
        options.symmetrisation = is_paper ? Symmetrisation::orbits : Symmetrisation::term;
    }
    check(!is_paper || options.symmetrisation == Symmetrisation::orbits,
          "--symmetrise term: needs --field convex; the paper averages over orbits");
    const bool is_twice_solved =
        options.symmetry == SymmetryMode::field && options.symmetrisation == Symmetrisation::orbits;
    if (!options.alpha) {
        // Symmetric quads cannot follow what the two sides do differently: less is asked of them.
        const double symmetric = is_twice_solved ? 0.2 : 0.1;
        options.alpha = is_paper || options.symmetry == SymmetryMode::none
                            ? default_alpha(options.field)
                            : symmetric;
    }
    if (!options.singularity_cost) {
        options.singularity_cost = options.symmetry == SymmetryMode::exact ? 0.1
                                   : is_twice_solved                       ? 0.2
                                                                           : 0.08;
    }
    if (!options.metric) {
        options.metric = *options.alpha == 0 ? MetricChoice::reference : MetricChoice::mean;
    }
    // Written so that a NaN fails.
    check(*options.alpha >= 0 && *options.alpha < 1,
          fmt::format("--alpha {}: has to be at least 0 and below 1", *options.alpha));
    check(std::isfinite(options.edge_length) && options.edge_length >= 0,
          fmt::format("--edge-length {}: has to be positive, or 0 to go by --vertices",
                      options.edge_length));
    check(options.edge_length > 0 || (options.vertices >= 8 && options.vertices <= 100'000'000),
          fmt::format("--vertices {}: has to be between 8 and 100000000", options.vertices));
    check(std::isfinite(options.curvature) && options.curvature >= 0,
          fmt::format("--curvature {}: has to be at least 0", options.curvature));
    check(std::isfinite(*options.singularity_cost) && *options.singularity_cost >= 0,
          fmt::format("--singularity-cost {}: has to be at least 0", *options.singularity_cost));
    check(options.feature_angle >= 0 && options.feature_angle <= 180,
          fmt::format("--feature-angle {}: has to be between 0 and 180 degrees",
                      options.feature_angle));
    check(options.relax_rounds >= 0,
          fmt::format("--relax {}: has to be at least 0", options.relax_rounds));
    if (options.reference == Options::rest_shape) {
        check(has_rest_shape, "--reference rest: the input has no rest shape; name a frame");
    } else {
        check(options.reference >= 0 && options.reference < frame_count,
              fmt::format("--reference {}: the input has frames 0 to {}", options.reference,
                          frame_count - 1));
    }
    return options;
}

}  // namespace kinequad
