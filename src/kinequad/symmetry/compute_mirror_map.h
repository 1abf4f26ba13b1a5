#pragma once

#include "kinequad/core/context.h"
#include "kinequad/mesh/intrinsic_metric.h"
#include "kinequad/symmetry/find_mirror_plane.h"
#include "kinequad/symmetry/symmetry_map.h"

namespace kinequad {

/// The symmetry map of a pose that a plane mirrors: the closest point of the surface to the
/// mirrored one, on the partner of a point's connected part and on the side that faces the same
/// way. Where the pose is not quite symmetric its parts are mirrored one by one (`match_parts`).
/// `metric` is over the edges of `build_topology(mesh.F, n)`; directions are
/// measured in it. Any genus, number of components and boundary. Throws `InputError` (symmetry)
/// where the plane does not cut the surface. docs/symmetry.md
SymmetryMap compute_mirror_map(const TriangleMesh& mesh, const MirrorPlane& plane,
                               const IntrinsicMetric& metric, const Context& context);

}  // namespace kinequad
