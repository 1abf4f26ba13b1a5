#pragma once

#include <vector>

#include "kinequad/core/types.h"
#include "kinequad/io/polygons.h"
#include "kinequad/measure/triangulation.h"
#include "kinequad/mesh/closest_points.h"
#include "kinequad/mesh/intrinsic_metric.h"
#include "kinequad/mesh/topology.h"

namespace kinequad {

/// What the directions of a quad mesh are measured against: the input at rest, and the quads over
/// it in one pose.
struct StretchReference {
    Positions V;  ///< n x 3: the input in the pose in which quads and triangles are matched
    Triangles F;  ///< m x 3
    /// m x 3: lengths of the half-edges of every triangle at rest. They need not be those of `V`.
    Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> sides;
    Positions X;     ///< v x 3: the quad mesh in the pose of `V`
    Polygons faces;  ///< faces of the quad mesh
};

/// The lengths at rest of all half-edges (m x 3), for `StretchReference::sides`.
Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> triangle_sides(
    const Topology& topology, const IntrinsicMetric& metric);

/// The crosses of a quad mesh over points of the input. docs/measures.md
class QuadCrosses {
public:
    /// The cross of one quad, and where it was found.
    struct Cross {
        /// Fourth power, of unit length, of the directions of the quad's sides in the frame of the
        /// triangle at rest; 0 where the face is no quad or its sides say nothing.
        Complex fourth_power = 0;
        int hint = -1;  ///< makes the search for a point nearby quick
    };

    /// `reference` has to outlive the object. Throws `InputError` (mesh) where the quad mesh has no
    /// face or a position is not finite.
    explicit QuadCrosses(const StretchReference& reference);

    /// The cross of the quad nearest to a point of the input in the pose of the reference, read off
    /// in the triangle of that point. Safe to call from several threads.
    Cross find(const SurfacePoint& point, int hint = -1) const;

    /// Edge vectors of triangle `t` at rest from corner 0, as columns, in the triangle's frame.
    Eigen::Matrix2d rest_shape(int t) const;

private:
    QuadCrosses(const StretchReference& reference, const Triangulation& cut);

    const StretchReference& reference_;
    std::vector<int> face_;  ///< the face that a triangle of `surface_` was cut from
    ClosestPoints surface_;
};

}  // namespace kinequad
