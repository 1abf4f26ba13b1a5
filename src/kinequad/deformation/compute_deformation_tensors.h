#pragma once

#include <optional>

#include "kinequad/core/context.h"
#include "kinequad/deformation/deformation_tensors.h"
#include "kinequad/io/frame_source.h"
#include "kinequad/mesh/intrinsic_metric.h"

namespace kinequad {

struct DeformationOptions {
    /// Wanted edge length of the quads, in units of the input: bends are measured in it. 0 leaves
    /// the curvature out (all zero).
    double edge_length = 0;
    /// Number of frames, evenly chosen, whose curvature is averaged.
    int curvature_frames = 12;
    /// The stretch of one frame enters `stretch_direction_sum`, `stretch_sum` and
    /// `stretch_square_sum` no larger than this quantile of the stretches of the same chosen
    /// frames, so that slivers do not rule. 1 takes every stretch as it is.
    double stretch_quantile = 0.99;
    /// Reads this frame only, as if it were the whole sequence.
    std::optional<int> only_frame = std::nullopt;
};

/// Measures how the frames deform every triangle against `metric`, and where they bend it. Reads
/// every frame once, and the chosen ones twice; holds one at a time. A triangle that a frame
/// collapses is left out of the sums for that frame, one that the metric collapses altogether. The
/// bound of the stretch goes to the log. Throws `InputError` (usage) where an option is out of its
/// range, what `FrameSource::read_frame` throws, and `Cancelled`. [Du and Tu, section 3.3]
/// docs/deformation.md
DeformationTensors compute_deformation_tensors(const FrameSource& frames, const Topology& topology,
                                               const IntrinsicMetric& metric,
                                               const DeformationOptions& options,
                                               const Context& context);

}  // namespace kinequad
