#pragma once

#include "kinequad/core/context.h"
#include "kinequad/io/frame_source.h"
#include "kinequad/pipeline/options.h"
#include "kinequad/pipeline/result.h"

namespace kinequad {

/// The main job: one quad mesh for all frames of `source`, verified after every stage.
///
/// Reads every frame twice where the metric is the mean, and only the reference where the run sees
/// a single pose; never holds more than a few frames. `observe` may be empty. Throws `InputError`
/// (usage) for an option out of its range, (mesh), naming `source`, for a surface that is not
/// manifold, oriented and of positive area; `GridMapError`, `VerificationError`, `Cancelled`, and
/// what the source throws. docs/pipeline.md
Result quadrangulate(const FrameSource& source, const Options& options, const Context& context,
                     const StageObserver& observe = {});

}  // namespace kinequad
