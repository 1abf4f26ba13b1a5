#pragma once

#include "kinequad/mesh/intrinsic_metric.h"

namespace kinequad {

/// Adds the same tiny length to all edges, so that the angles of every triangle are well defined:
/// in each, two sides together are longer than the third by at least 1e-6 of the mean edge length.
/// Nothing changes where they are already. [Sharp 2020], "intrinsic mollification"
IntrinsicMetric widen_flat_triangles(const Topology& topology, IntrinsicMetric metric);

}  // namespace kinequad
