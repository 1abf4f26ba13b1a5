#pragma once

#include <vector>

#include "kinequad/field/cross_field.h"
#include "kinequad/mesh/intrinsic_metric.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {

/// Lines that follow the arms of a cross field, for pictures: from the middles of triangles that no
/// line has come near yet, along both arms and both ways, up to `length` (units of the metric) each
/// way, less at the boundary. A line has a point on every edge it crosses; crossing an edge it goes
/// on along the arm nearest to its direction. Lines start in an order that spreads them, the same
/// every time. docs/field.md
std::vector<std::vector<SurfacePoint>> trace_streamlines(const Topology& topology,
                                                         const IntrinsicMetric& metric,
                                                         const CrossField& field, double length);

}  // namespace kinequad
