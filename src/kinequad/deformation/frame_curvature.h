#pragma once

#include <vector>

#include "kinequad/core/context.h"
#include "kinequad/mesh/intrinsic_metric.h"

namespace kinequad {

/// Measures in which direction a frame bends most in every triangle. Holds what does not depend on
/// the frame. Internal to this stage.
class FrameCurvature {
public:
    FrameCurvature(const Topology& topology, const IntrinsicMetric& metric);

    /// Adds `x / (1 + x) exp(4 i theta)` of every triangle (m) to `sum`: theta the direction of the
    /// strongest bend in frame `V` (n x 3), `x` the square of the bend over `edge_length`.
    void accumulate(const Positions& V, double edge_length, const Context& context,
                    Eigen::VectorXcd& sum) const;

private:
    const Topology& topology_;
    std::vector<Complex> across_;  ///< 3m: exp(2i (direction + pi/2)) of a half-edge
    std::vector<Complex>
        arriving_;  ///< 3m: turns second powers from across a half-edge into its triangle
};

}  // namespace kinequad
