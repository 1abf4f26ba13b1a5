#pragma once

#include "kinequad/mesh/intrinsic_metric.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {

/// The point reached by walking straight on a surface from `start` along `direction`, a vector in
/// the frame of the start's triangle (see `IntrinsicMetric`) whose length is the way to go.
/// Neighbouring triangles are unfolded on the way. The walk ends at the boundary, and after
/// crossing 1000 triangles.
SurfacePoint trace_geodesic(const Topology& topology, const IntrinsicMetric& metric,
                            const SurfacePoint& start, const Vector2& direction);

}  // namespace kinequad
