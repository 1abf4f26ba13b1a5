#pragma once

#include "kinequad/core/context.h"
#include "kinequad/io/frame_source.h"
#include "kinequad/pipeline/solve_quads.h"

namespace kinequad {

/// The whole surface of a run, as it is solved.
struct SolvedSurface {
    const FrameSource& frames;
    const Topology& topology;
    const IntrinsicMetric& metric;
    const Positions& reference;  ///< n x 3
};

/// The quads of a surface whose cross field is symmetric, with the stationary curve of
/// `result.symmetry` inserted as an integer line. Fills in domain, tensors, field and map of
/// `result` and calls `finish_stage` after each stage. Vertices are points of the surface. Throws
/// as `quadrangulate`. docs/symmetry.md, "A symmetric field"
QuadMesh solve_symmetric_field(const SolvedSurface& surface, Result& result, const Context& context,
                               const StageEnd& finish_stage);

/// The quads of a surface whose one half, up to the stationary curve of `result.symmetry`, is
/// solved for both sides together, then mirrored. As `solve_symmetric_field`; sets
/// `QuadMesh::mirror`. docs/symmetry.md, "Quads that mirror exactly"
QuadMesh solve_mirrored_half(const SolvedSurface& surface, Result& result, const Context& context,
                             const StageEnd& finish_stage);

}  // namespace kinequad
