#pragma once

#include "kinequad/core/types.h"

namespace kinequad {

/// What the frames do to every triangle, measured against one metric and summed up over the frames.
/// All directions are fourth powers `exp(4 i theta)` in the frame of the triangle (see
/// `IntrinsicMetric`), so that theta and theta + pi/2 are the same cross.
struct DeformationTensors {
    int frame_count = 0;
    /// m: `sum_j s_j exp(4 i theta_j)`, `s = s1 / s2 - 1` [Du and Tu, eq. 7]. Its modulus
    /// says how strongly and how consistently the triangle is stretched.
    Eigen::VectorXcd stretch_direction_sum;
    /// m: `sum_j s_j` and `sum_j s_j^2` [Du and Tu, eq. 8].
    Eigen::VectorXd stretch_sum;
    Eigen::VectorXd stretch_square_sum;
    /// m: mean over some frames of `x / (1 + x) exp(4 i theta)` of the smoothed curvature, in [0,
    /// 1] by modulus. docs/deformation.md
    Eigen::VectorXcd curvature;
};

/// What two animations of the same triangles do to them together, each measured against a metric of
/// its own: the two sides of a symmetric surface, seen as one.
DeformationTensors add_tensors(const DeformationTensors& a, const DeformationTensors& b);

}  // namespace kinequad
