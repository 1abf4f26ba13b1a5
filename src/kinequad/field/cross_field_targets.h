#pragma once

#include "kinequad/deformation/deformation_tensors.h"
#include "kinequad/field/cross_field_method.h"
#include "kinequad/mesh/intrinsic_metric.h"

namespace kinequad {

/// What the crosses are drawn to: a direction and a weight in every triangle, the soft terms
/// `weight_t (theta_t - target_t)^2` beside the smoothness `sum_e w_e^2` of unit weight.
struct CrossFieldTargets {
    Eigen::VectorXcd value;  ///< m: `exp(4 i target)`, of modulus 1, in the frame of the triangle
    Eigen::VectorXd weight;  ///< m: not negative; 0 where nothing is asked
};

/// How deformation becomes targets. docs/field.md
struct CrossFieldTargetOptions {
    CrossFieldMethod method = CrossFieldMethod::convex;
    /// Influence of the animation, 0 for none. `convex`: the factor of the bounded stretch;
    /// `paper`: the alpha of energy (9), in [0, 1). See `default_alpha`.
    double alpha = default_alpha(CrossFieldMethod::convex);
    double curvature_weight = 0.1;  ///< factor of the curvature (`convex` only)
    /// Wanted edge length of the quads, in units of the input: areas are measured in its square, so
    /// that targets do not depend on how finely the triangles sample the surface (`convex` only).
    double edge_length = 0;
    double smallest_stretch = 0.5;  ///< mean stretch of no weight (`paper` only)
    double largest_stretch = 2;     ///< mean stretch of full weight, and its bound (`paper` only)
};

/// Turns what the animation does to every triangle into targets of the cross field: for `convex`
/// `G = alpha S / (1 + |S|) + curvature_weight curvature`, `S` the mean stretch, weighted by `4 A
/// |G| / edge_length^2`; for `paper` equations (7) and (8) of Du and Tu with weight `alpha / (1 -
/// alpha) w`, where `w` rises from 0 to 1 between `smallest_stretch` and `largest_stretch` and what
/// is below 0.1 asks for nothing. docs/field.md Throws `InputError` (usage) where an option is out
/// of its range.
CrossFieldTargets compute_cross_field_targets(const Topology& topology,
                                              const IntrinsicMetric& metric,
                                              const DeformationTensors& tensors,
                                              const CrossFieldTargetOptions& options);

}  // namespace kinequad
