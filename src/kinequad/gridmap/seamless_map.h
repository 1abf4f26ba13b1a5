#pragma once

#include "kinequad/core/context.h"
#include "kinequad/gridmap/map_system.h"

namespace kinequad {

/// A map with the rotations of the field and real translations, and how its energy grows when the
/// integer unknowns are moved away from their best real values.
struct SeamlessMap {
    Eigen::VectorXd x;              ///< values of all columns of the injective map
    Eigen::VectorXd integers;       ///< p: integer unknowns of that map, real numbers here
    Eigen::VectorXd best_integers;  ///< p: integer unknowns of the map of least energy
    Eigen::MatrixXd stiffness;  ///< p x p: half the second derivative of the least energy in them
    int reversed_triangles =
        0;  ///< triangles turned by more than a right angle or mirrored; 0 if found
};

/// The seamless map of least energy `sum_t A_t |J_t - 1|^2` and, by alternating projections on the
/// triangles that keep their orientation within a right angle of the cross, one near it that is
/// injective around every vertex. docs/gridmap.md, "Seamless map"
SeamlessMap solve_seamless_map(const MapVariables& variables, TriangleSystem& system,
                               const std::vector<TargetShape>& shapes, const Context& context);

/// Whether the image of a triangle, `corners` three of them, is neither mirrored nor turned by more
/// than a right angle against its chart.
bool keeps_direction(const TargetShape& shape, const Complex* corners);

}  // namespace kinequad
