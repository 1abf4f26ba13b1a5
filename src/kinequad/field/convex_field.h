#pragma once

#include "kinequad/field/field_problem.h"

namespace kinequad {

/// Angles (m, radians) of the smoothest field of fourth powers `z = exp(4 i theta)` whose moduli
/// are free: the minimiser of `sum_e |exp(4 i kappa) z_i - z_j|^2 + sum_t weight |z_t - target|^2
/// + symmetry |z_image - exp(4 i transport) conj(z)|^2`,
/// in components where nothing is asked the eigenvector of the least eigenvalue [Knoppel et al.
/// 2013]. Internal.
Eigen::VectorXd solve_convex_field(const FieldProblem& problem, const Context& context);

}  // namespace kinequad
