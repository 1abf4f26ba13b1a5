#pragma once

#include <string>

#include "kinequad/core/context.h"
#include "kinequad/extract/quad_mesh.h"
#include "kinequad/io/frame_sink.h"
#include "kinequad/io/frame_source.h"

namespace kinequad {

/// Writes the quad mesh in every frame of `source` to `sink`, which was made for as many frames and
/// the vertices of `quads`, and finishes it. Reads every frame once and holds one. Returns the
/// digest of the frames read, as `compute_digest`. Throws what source and sink throw, and
/// `Cancelled`.
std::string write_quad_frames(const QuadMesh& quads, const FrameSource& source, FrameSink& sink,
                              const Context& context);

}  // namespace kinequad
