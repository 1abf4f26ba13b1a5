#pragma once

#include <vector>

#include "kinequad/mesh/intrinsic_metric.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {

/// Triangles around one triangle, laid out in the plane of its frame one after the other.
struct UnfoldedPatch {
    std::vector<int> triangle;                         ///< breadth first; the middle one is first
    std::vector<Eigen::Matrix<double, 2, 3>> corners;  ///< positions of their corners, as columns

    /// Position of a surface point, where its triangle is in the patch.
    bool find(const SurfacePoint& point, Vector2& position) const;
};

/// Lays out the triangles around `middle`, at most `limit`, until all of `wanted` are among them.
UnfoldedPatch unfold_patch(const Topology& topology, const IntrinsicMetric& metric, int middle,
                           const std::vector<int>& wanted, int limit);

}  // namespace kinequad
