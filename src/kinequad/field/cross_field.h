#pragma once

#include <numbers>

#include "kinequad/core/types.h"

namespace kinequad {

/// A quarter turn in radians, by which a cross is the same cross again.
inline constexpr double quarter = std::numbers::pi / 2;

/// A cross in every triangle, and how the crosses of neighbours correspond.
///
/// Across edge `e` with lower half-edge `h` in triangle i (`Topology::edge_half_edge`) and triangle
/// j on the other side, `kappa = frame_rotation(h)` carries a direction of i into the frame of j,
/// and `w_e = angle_i + kappa + pi/2 period_jump_e - angle_j` is what the crosses differ by [Bommes
/// et al. 2009]. Boundary edges have period jump 0.
struct CrossField {
    Eigen::VectorXd angle;        ///< m: one arm of the cross, in radians in the triangle's frame
    Eigen::VectorXi period_jump;  ///< e: period jump across an edge, in quarter turns
    /// n: singularity index in quarters; 0 at regular vertices. On the boundary it counts the
    /// corners of the aligned field: +1 at a convex right angle. Sums to four times the Euler
    /// characteristic.
    Eigen::VectorXi index;
    double energy = 0;  ///< energy (9) of Du and Tu, or its bounded-weight form: see docs/field.md
};

}  // namespace kinequad
