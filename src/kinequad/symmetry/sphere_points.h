#pragma once

#include "kinequad/core/types.h"
#include "kinequad/symmetry/double_double.h"

namespace kinequad {

/// Number type of coordinates on the sphere.
using Real = DoubleDouble;
using RealVector3 = Eigen::Matrix<Real, 3, 1>;
/// Points of the unit sphere, one a row.
using SpherePoints = Eigen::Matrix<Real, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// Six times the signed volume of the tetrahedron (origin, a, b, q): positive where q lies left of
/// the arc from a to b. Formed from differences, so that tiny triangles keep their sign.
inline Real arc_side(const RealVector3& a, const RealVector3& b, const RealVector3& q) {
    return (a - q).cross(b - q).dot(q);
}

}  // namespace kinequad
