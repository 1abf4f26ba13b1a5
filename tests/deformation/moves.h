#pragma once

#include <cmath>

#include "kinequad/core/types.h"

namespace kinequad::test {

/// A rotation about no axis in particular, and a shift.
inline Positions moved_rigidly(const Positions& V, double angle) {
    const Eigen::Matrix3d R =
        Eigen::AngleAxisd(angle, Vector3(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
    return (V * R.transpose()).rowwise() + Eigen::RowVector3d(3, -2, 0.5);
}

/// The xy-plane stretched by `factor` along the direction at `angle` to the x-axis.
inline Positions stretched(const Positions& V, double factor, double angle) {
    const Vector3 d(std::cos(angle), std::sin(angle), 0);
    const Eigen::Matrix3d S = Eigen::Matrix3d::Identity() + (factor - 1) * d * d.transpose();
    return V * S;
}

}  // namespace kinequad::test
