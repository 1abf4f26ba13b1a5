#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <complex>

namespace kinequad {

using Vector2 = Eigen::Vector2d;
using Vector3 = Eigen::Vector3d;
using Complex = std::complex<double>;

/// Points in space, one a row (n x 3).
using Positions = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
/// Triangles as rows of three vertex indices (m x 3), counter-clockwise seen from outside.
using Triangles = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;
/// Quads as rows of four vertex indices (q x 4), counter-clockwise seen from outside.
using Quads = Eigen::Matrix<int, Eigen::Dynamic, 4, Eigen::RowMajor>;

}  // namespace kinequad
