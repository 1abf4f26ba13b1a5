#pragma once

#include "kinequad/field/field_problem.h"

namespace kinequad {

/// Finds period jumps by greedy mixed-integer rounding: relax, round the period closest to an
/// integer, re-solve the angles around it by Gauss-Seidel, and everywhere where that does not
/// settle [Bommes et al. 2009].
///
/// Every triangle with a target or a given cross has its own gauge, the others hang on the nearest
/// of them by a forest of edges of period 0; all other periods are free, so that no target is
/// pinned to one of its four representatives. Internal to this stage. docs/field.md
FieldState round_greedily(const FieldProblem& problem, const Context& context);

}  // namespace kinequad
