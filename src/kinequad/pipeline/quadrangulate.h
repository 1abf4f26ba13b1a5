#pragma once

#include <optional>

#include "kinequad/core/context.h"
#include "kinequad/io/frame_source.h"
#include "kinequad/io/landmarks.h"
#include "kinequad/pipeline/options.h"
#include "kinequad/pipeline/result.h"

namespace kinequad {

/// The main job: one quad mesh for all frames of `source`, verified after every stage.
///
/// Reads every frame a few times, and only the reference where the run sees a single pose; holds
/// two dozen of each side at most, fewer of large meshes. `landmarks` tell what the user knows of
/// the symmetry of the surface; they matter with the symmetries `field` and `exact`. `observe` may
/// be empty. Throws `InputError` (usage) for an option out of its range, (mesh), naming `source`,
/// for a surface that is not manifold, oriented and of positive area, (symmetry) where a symmetry
/// is asked for and not found; `GridMapError`, `VerificationError`, `Cancelled`, and what the
/// source throws. docs/pipeline.md
Result quadrangulate(const FrameSource& source, const std::optional<Landmarks>& landmarks,
                     const Options& options, const Context& context,
                     const StageObserver& observe = {});

}  // namespace kinequad
