#pragma once

#include <functional>
#include <vector>

#include "kinequad/core/context.h"
#include "kinequad/io/frame_source.h"
#include "kinequad/pipeline/result.h"

namespace kinequad {

/// The lengths that a surface with triangles `topology` is known by, as `options` ask for: those of
/// the pose `reference` (n x 3), or the mean ones of `frames`.
IntrinsicMetric choose_metric(const FrameSource& frames, const Topology& topology,
                              const Positions& reference, const Options& options,
                              const Context& context);

/// An animation of the domain: the frames of its one side, or of the other.
struct DomainView {
    const FrameSource& frames;
    Positions reference;  ///< n' x 3: the pose in which no quad may fold
    /// Of these frames or the reference; what deformation is measured against, so that what is
    /// different between the two sides does not count as deformation.
    IntrinsicMetric metric;
};

/// Solves the cross field of `result.domain`: tensors and field, verified; with the symmetry
/// `field` twice, the second time drawn to the first one's average over the orbits of
/// `result.symmetry`, whose triangles are the domain's then. Fills in `tensors`, `field` and the
/// domain's features, and calls `finish_stage` after each stage. Throws as `quadrangulate`.
void solve_field(const std::vector<DomainView>& views, Result& result, const Context& context,
                 const std::function<void(const char* stage)>& finish_stage);

/// Makes quads of `result.field` over `result.domain`: map, extraction and relaxation, each
/// verified. Fills in `map` and calls `finish_stage` after each stage. Returns the quads, whose
/// vertices are points of the domain's triangles. Throws as `quadrangulate`.
QuadMesh solve_quads(const std::vector<DomainView>& views, Result& result, const Context& context,
                     const std::function<void(const char* stage)>& finish_stage);

}  // namespace kinequad
