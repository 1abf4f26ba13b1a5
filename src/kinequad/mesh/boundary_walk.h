#pragma once

#include <vector>

#include "kinequad/mesh/intrinsic_metric.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {

/// Walks along chains of boundary edges. `topology` and `metric` have to outlive this.
class BoundaryWalk {
public:
    /// `edges` are the boundary edges that walks keep to; others are passed over.
    BoundaryWalk(const Topology& topology, const IntrinsicMetric& metric,
                 const std::vector<int>& edges);

    /// The half-edge of the walk's edges that a point lies on, by its barycentric coordinates; -1
    /// where there is none, and at the ends of chains.
    int half_edge_of(const SurfacePoint& point) const;
    /// Direction of a half-edge as a unit vector in the frame of its triangle.
    Vector2 direction(int half_edge) const;
    /// The point at `length` (units of the input, negative for backward) from a point on
    /// `half_edge`; stops at the end of the chain.
    SurfacePoint walk(const SurfacePoint& start, int half_edge, double length) const;

private:
    const Topology& topology_;
    const IntrinsicMetric& metric_;
    std::vector<int> next_;      ///< half-edge: the one of the walk that follows, -1 for none
    std::vector<int> previous_;  ///< half-edge
    std::vector<char> is_walked_;
};

}  // namespace kinequad
