#pragma once

#include <vector>

#include "kinequad/field/compute_cross_field.h"

namespace kinequad {

/// By how much the crosses beside `options.mirror_edges` are turned against their edges (e,
/// radians, 0 at all other edges), so that along a chain of mirror edges they turn evenly. A line
/// of symmetry that was cut into a triangulation zigzags; over about one and a half quad edges,
/// `options.edge_length`, this is smoothed out. No cross is turned by more than 35 degrees: beyond
/// 45 it would be aligned with the line by its other arm. Internal to this stage. docs/field.md
std::vector<double> even_turns(const Topology& topology, const IntrinsicMetric& metric,
                               const CrossFieldOptions& options);

}  // namespace kinequad
