#pragma once

#include "kinequad/field/compute_cross_field.h"

namespace kinequad {

/// What `verify_cross_field` finds.
struct CrossFieldReport {
    bool finite = false;         ///< every angle is a number
    int index_sum = 0;           ///< sum of the indices, in quarters
    int expected_index_sum = 0;  ///< four times the Euler characteristic
    int wrong_indices = 0;       ///< vertices whose index is not the holonomy of angles and periods
    int broken_holonomies = 0;   ///< vertices whose holonomy is not a whole number of quarter turns
    int periods_on_boundary = 0;  ///< boundary edges with a period jump
    int unaligned_triangles = 0;  ///< fixed triangles whose cross is turned off what it has to keep
    int angleless_vertices =
        0;  ///< vertices whose index leaves a map no angle: 4 or more, 2 on the boundary
    int adjacent_singularities = 0;  ///< mesh edges that join two singularities
    int large_residuals = 0;         ///< edges with |w_e| > pi/4
    double largest_residual = 0;     ///< largest |w_e|, radians

    /// True where the field is consistent and keeps what it has to. Vertices without angle,
    /// adjacent singularities and large residuals make a map harder, not the field wrong.
    bool valid() const;
};

/// Checks a cross field against the metric it was computed on. `options` names what it had to keep.
CrossFieldReport verify_cross_field(const Topology& topology, const IntrinsicMetric& metric,
                                    const CrossField& field, const CrossFieldOptions& options);

}  // namespace kinequad
