#pragma once

#include "kinequad/field/cross_field.h"
#include "kinequad/field/cross_field_targets.h"
#include "kinequad/mesh/intrinsic_metric.h"
#include "kinequad/mesh/refined_mesh.h"

namespace kinequad {

/// The same cross field on a refinement of its mesh: parts of a triangle have its cross, edges
/// inside a triangle have no residual, parts of an edge have that of the edge. `topology` and
/// `metric` are the field's, `fine_topology` that of `fine.F` with the lengths `fine_metric`. The
/// vertices of the field's mesh come first in the refined one; the others are regular.
CrossField refine_cross_field(const CrossField& field, const Topology& topology,
                              const IntrinsicMetric& metric, const RefinedMesh& fine,
                              const Topology& fine_topology, const IntrinsicMetric& fine_metric);

/// The same targets on a refinement of their mesh, or on a part of one, `fine`: parts of a triangle
/// have its target. `topology` and `metric` are the targets'.
CrossFieldTargets refine_targets(const CrossFieldTargets& targets, const Topology& topology,
                                 const IntrinsicMetric& metric, const RefinedMesh& fine);

}  // namespace kinequad
