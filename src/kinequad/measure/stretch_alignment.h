#pragma once

#include <vector>

#include "kinequad/core/context.h"
#include "kinequad/core/types.h"
#include "kinequad/measure/quad_crosses.h"

namespace kinequad {

/// How well the edges of a quad mesh follow the stretch of an animation: the angle, modulo 90
/// degrees, between the principal stretch direction of a triangle and the cross of the quad over
/// its centre, as a mean over triangles and frames weighted by area at rest and stretch `s = s1 /
/// s2 - 1`. 22.5 degrees for edges that do not care, 0 for edges that follow exactly. Frames are
/// added one at a time and not kept. docs/measures.md
class StretchAlignment {
public:
    /// Finds the quad over every triangle's centre and its cross. Throws `InputError` (mesh) where
    /// the quad mesh has no face or a position is not finite.
    explicit StretchAlignment(const StretchReference& reference, const Context& context = {});

    /// Adds the frame whose vertex positions are `V` (n x 3). Triangles that collapse in it are
    /// left out, as are those under a face that is no quad or under a quad without extent.
    void add_frame(const Positions& V, const Context& context = {});

    /// The mean over the frames so far, in degrees; not a number where nothing was stretched.
    double degrees() const { return weight_ > 0 ? weighted_degrees_ / weight_ : unknown; }

private:
    static const double unknown;

    Triangles F_;
    std::vector<Eigen::Matrix2d> inverse_rest_;  ///< m: inverse of the edge vectors at rest
    Eigen::VectorXd area_;                       ///< m: at rest, 0 where the triangle is left out
    Eigen::VectorXcd cross_;                     ///< m: unit fourth power of the quad's cross
    double weight_ = 0;
    double weighted_degrees_ = 0;
};

}  // namespace kinequad
