#pragma once

#include "kinequad/mesh/intrinsic_metric.h"
#include "kinequad/symmetry/symmetry_map.h"

namespace kinequad {

/// A symmetry map with its stationary curve faired: the heights of `map` are diffused over the
/// surface, which takes out bends shorter than about `length` (units of the input), such as those
/// at needle triangles, and moves the curve by its curvature times the square of `length` at most,
/// about. Its polylines, directions and heights are replaced, images and transport stay. Where the
/// number of its lines would change, `length` is halved for all of it, up to three times; if that
/// does not help, it stays as it is.
/// docs/symmetry.md
SymmetryMap fair_stationary_curve(const SymmetryMap& map, const Topology& topology,
                                  const IntrinsicMetric& metric, double length);

}  // namespace kinequad
