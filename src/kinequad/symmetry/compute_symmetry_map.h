#pragma once

#include "kinequad/core/context.h"
#include "kinequad/io/landmarks.h"
#include "kinequad/mesh/intrinsic_metric.h"
#include "kinequad/symmetry/symmetry_map.h"

namespace kinequad {

/// How a symmetry map is made.
struct SymmetryOptions {
    /// Largest mean distance of `p` and `S(S(p))`, in percent of the bounding-box diagonal, that is
    /// still called an involution.
    double involution_percent = 2;
    /// Largest difference between the two sides in a landmark's distances to the others, their
    /// upper quartile in percent of the surface's extent, beyond which the landmark is called
    /// wrong; 5 % and five times what is usual among the landmarks is enough, too.
    double landmark_percent = 8;
};

/// Computes the bilateral intrinsic symmetry of a surface from landmarks: conformal map
/// to the sphere, least-squares anti-involution, smooth map of the landmarks to symmetric places.
/// `mesh` holds the positions of a reference shape, which only decide which seams coincide and how
/// distances are reported; `metric` is over the edges of `build_topology(mesh.F, n)`, the mean
/// metric or that of the reference. Landmarks in any order; the order in a pair does not matter.
/// Throws `InputError` (symmetry) where landmarks repeat, are too few, or one or two disagree with
/// the others, naming them; where the surface has parts that do not join; where the result is no
/// involution. Warns where it is none in places, and of pairs that are the other way around than
/// most. [DuTu], [Panozzo 2012], docs/symmetry.md
SymmetryMap compute_symmetry_map(const TriangleMesh& mesh, const IntrinsicMetric& metric,
                                 const Landmarks& landmarks, const SymmetryOptions& options,
                                 const Context& context);

}  // namespace kinequad
