#pragma once

namespace kinequad {

/// How periods of a cross field are found. docs/field.md
enum class CrossFieldMethod {
    convex,  ///< one convex solve, then a search over the periods: fewer singularities, faster
    paper,   ///< greedy mixed-integer rounding of energy (9) of Du and Tu [Bommes et al. 2009]
};

/// The influence of the animation that was measured best with each method; 0 always means none.
constexpr double default_alpha(CrossFieldMethod) { return 0.5; }

}  // namespace kinequad
