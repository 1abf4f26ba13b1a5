#pragma once

#include "kinequad/core/types.h"
#include "kinequad/io/polygons.h"

namespace kinequad {

/// How well the quads of one frame are shaped. Faces that are no quads do not count. All 0, and 1
/// for the scaled Jacobian, where there is no quad.
struct QuadShapeMetrics {
    /// `|angle - 90|` over all corners of all quads, angles between the two sides in space, in
    /// degrees.
    double angle_deviation_mean = 0;
    double angle_deviation_max = 0;
    /// Over the quads, of the smallest of the four corners' scaled Jacobians: the sine of the angle
    /// from the next side to the previous one, seen along the quad's vector area. 1 at a right
    /// angle in the plane, 0 or less where the quad is folded, -1 where it is collapsed.
    double scaled_jacobian_min = 1;
    double scaled_jacobian_mean = 1;
    int folded_quads = 0;  ///< quads whose scaled Jacobian is 0 or less
};

/// Measures the quads among `faces` in the pose `V` (n x 3). docs/measures.md
QuadShapeMetrics measure_shape(const Positions& V, const Polygons& faces);
QuadShapeMetrics measure_shape(const Positions& V, const Quads& Q);

}  // namespace kinequad
