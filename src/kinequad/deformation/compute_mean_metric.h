#pragma once

#include "kinequad/core/context.h"
#include "kinequad/io/frame_source.h"
#include "kinequad/mesh/intrinsic_metric.h"

namespace kinequad {

/// Averages the edge lengths over all frames: the intrinsic mean shape. The mean of lengths that
/// satisfy the triangle inequality satisfies it too. Reads every frame once and holds one at a
/// time. Throws what `FrameSource::read_frame` throws, and `Cancelled`. docs/deformation.md
IntrinsicMetric compute_mean_metric(const FrameSource& frames, const Topology& topology,
                                    const Context& context);

}  // namespace kinequad
