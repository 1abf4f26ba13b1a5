#pragma once

#include <vector>

#include "kinequad/core/context.h"
#include "kinequad/symmetry/symmetric_half.h"

namespace kinequad {

/// Moves the mirrored points of a half over the surface so that the map from the half to the other
/// side keeps lengths as well as it can. The conformal map and the warp to landmarks put every
/// point near to its place, but stretch the surface on the way; quads that are mirrored by the map
/// would be sheared as much.
///
/// As-rigid-as-possible energy: in turns every triangle chooses the reflection nearest to what
/// happens to it, and all points move where their triangles, with cotangent weights, ask them to,
/// by one sparse solve in the tangent planes and straight walks. The curve and boundary points
/// stay. `half_metric` is over the edges of `build_topology(half.mesh.F, n')`, `topology` and
/// `metric` are those of the input. The energy never rises. Throws `Cancelled`. [Sorkine and Alexa
/// 2007] docs/symmetry.md
std::vector<SurfacePoint> even_out_half(const SymmetricHalf& half,
                                        const IntrinsicMetric& half_metric,
                                        const Topology& topology, const IntrinsicMetric& metric,
                                        int rounds, const Context& context);

}  // namespace kinequad
