#pragma once

#include <functional>
#include <vector>

#include "kinequad/core/context.h"
#include "kinequad/io/frame_source.h"
#include "kinequad/pipeline/result.h"

namespace kinequad {

/// An animation of the domain: the frames of its one side, or of the other.
struct DomainView {
    const FrameSource& frames;
    Positions reference;  ///< n' x 3: the pose in which no quad may fold
    /// Of these frames or the reference; what deformation is measured against, so that what is
    /// different between the two sides does not count as deformation.
    IntrinsicMetric metric;
};

/// Solves the quads of `result.domain`: tensors, field, map, extraction and relaxation, each
/// verified. Fills in `tensors`, `field` and `map` of `result` and calls `finish_stage` after each
/// stage. Returns the quads, whose vertices are points of the domain's triangles. Throws as
/// `quadrangulate`.
QuadMesh solve_quads(const std::vector<DomainView>& views, Result& result, const Context& context,
                     const std::function<void(const char* stage)>& finish_stage);

}  // namespace kinequad
