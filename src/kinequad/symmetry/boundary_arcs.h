#pragma once

#include <vector>

#include "kinequad/mesh/intrinsic_metric.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {

/// A place on the boundary of a surface.
struct BoundaryPlace {
    int loop = -1;        ///< number in `boundary_loops`, -1 for a point off the boundary
    double position = 0;  ///< length from the start of the loop along it, the surface on the left
};

/// The boundary loops of a surface by the length along them. `topology` and `metric` have to
/// outlive this.
class BoundaryArcs {
public:
    BoundaryArcs(const Topology& topology, const IntrinsicMetric& metric);

    /// Where a point lies on the boundary, if its barycentric coordinates say so exactly.
    BoundaryPlace locate(const SurfacePoint& point) const;
    /// The point at a place; positions are taken modulo the length of the loop.
    SurfacePoint point_at(const BoundaryPlace& place) const;
    /// Length of a loop, in units of the input.
    double length(int loop) const;

private:
    struct Edge {
        int half_edge;
        double start;
        double length;
    };
    const Topology& topology_;
    std::vector<std::vector<Edge>> loops_;
    std::vector<BoundaryPlace> start_;  ///< half-edge: its place; loop -1 inside the surface
    std::vector<double> length_;        ///< half-edge: its length, 0 inside the surface
};

}  // namespace kinequad
