#pragma once

namespace kinequad {

/// How periods of a cross field are found. docs/field.md
enum class CrossFieldMethod {
    convex,  ///< one convex solve, then a search over the periods: fewer singularities, faster
    paper,   ///< greedy mixed-integer rounding of energy (9) of Du and Tu [Bommes et al. 2009]
};

/// The influence of the animation that was measured best with each method; 0 always means none.
constexpr double default_alpha(CrossFieldMethod method) {
    return method == CrossFieldMethod::paper ? 0.5 : 0.4;
}

}  // namespace kinequad
