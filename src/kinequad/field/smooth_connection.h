#pragma once

#include "kinequad/field/field_problem.h"

namespace kinequad {

/// The same problem over a connection whose curvature is spread over about `length`, so that bumps
/// smaller than it hold no singularities. Period jumps and indices keep their meaning, as `kappa`
/// and `defect` change together. The connection around fixed triangles stays as it is. Internal to
/// this stage. docs/field.md
FieldProblem smooth_connection(const FieldProblem& problem, const Topology& topology,
                               const IntrinsicMetric& metric, double length);

}  // namespace kinequad
