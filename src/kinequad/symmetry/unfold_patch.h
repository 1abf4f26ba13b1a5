#pragma once

#include <vector>

#include "kinequad/mesh/intrinsic_metric.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {

/// Triangles around one triangle, laid out in the plane of its frame one after the other.
struct UnfoldedPatch {
    std::vector<int> triangle;                         ///< breadth first; the middle one is first
    std::vector<Eigen::Matrix<double, 2, 3>> corners;  ///< positions of their corners, as columns
    std::vector<Vector2> position;                     ///< of the wanted points
    std::vector<bool> is_found;                        ///< which of these are in the patch
};

/// Lays out the triangles around `middle`, at most `limit`, until all of `wanted` are among them. A
/// point on an edge or a vertex is taken from the first triangle that it belongs to, whichever
/// triangle it is given in.
UnfoldedPatch unfold_patch(const Topology& topology, const IntrinsicMetric& metric, int middle,
                           const std::vector<SurfacePoint>& wanted, int limit);

}  // namespace kinequad
