#pragma once

#include <optional>

#include "kinequad/core/context.h"
#include "kinequad/io/frame_source.h"
#include "kinequad/io/landmarks.h"
#include "kinequad/mesh/intrinsic_metric.h"
#include "kinequad/symmetry/symmetry_map.h"
#include "kinequad/symmetry/verify_symmetry_map.h"

namespace kinequad {

/// A symmetry map and what its verifier found.
struct FoundSymmetry {
    SymmetryMap map;
    SymmetryReport report;
};

/// The symmetry map of an animated surface: from landmarks on `metric`, the mean one mostly, or,
/// where there are none, from the mirror plane of a pose that is symmetric in space, or nearly so
/// if the surface has several parts. `metric` is over the source's edges; `reference` (n x 3) is
/// the shape in which seams are found and distances reported.
///
/// Throws `InputError` (mesh) for a surface that is not manifold or oriented; (symmetry) where the
/// landmarks do not fit, or there are none and no pose is symmetric; `VerificationError`;
/// `Cancelled`. docs/symmetry.md
FoundSymmetry find_symmetry(const FrameSource& source, const IntrinsicMetric& metric,
                            const std::optional<Landmarks>& landmarks, const Positions& reference,
                            const Context& context);

}  // namespace kinequad
