#pragma once

#include <vector>

#include "kinequad/mesh/topology.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {

/// Finds points of a surface that is seen in several poses at once. A place is given by where it is
/// in every pose, one column each; the point nearest to it is the one whose squared distances, over
/// all poses, have the least sum. Parts that touch in one pose are apart in another, and the search
/// only walks from triangle to neighbouring triangle, so that it stays on its part of the surface.
class PoseSearch {
public:
    using Place = Eigen::Matrix3Xd;

    /// `F` m x 3 triangles, `poses` at least one n x 3 array each. All have to outlive this.
    PoseSearch(const Topology& topology, const Triangles& F, const std::vector<Positions>& poses)
        : topology_(topology), F_(F), poses_(poses) {}

    /// Where vertex `v` is in every pose.
    Place place(int v) const;
    /// Where a point of the surface is in every pose.
    Place place(const SurfacePoint& point) const;

    /// The nearest point that a walk downhill from triangle `start` reaches.
    SurfacePoint find(const Place& wanted, int start) const;

private:
    struct Found {
        SurfacePoint point;
        double distance2 = 0;
    };
    Found nearest_in(int t, const Place& wanted) const;

    const Topology& topology_;
    const Triangles& F_;
    const std::vector<Positions>& poses_;
};

}  // namespace kinequad
