#pragma once

#include "kinequad/core/context.h"
#include "kinequad/extract/quad_mesh.h"
#include "kinequad/io/frame_source.h"
#include "kinequad/mesh/intrinsic_metric.h"

namespace kinequad {

struct RelaxOptions {
    /// Frames whose quads are looked at: evenly chosen, the reference among them. At least 1.
    int sampled_frames = 12;
    /// Frame in which no quad may stay folded; counts about a quarter as much as all others
    /// together.
    int reference_frame = 0;
    /// True where the reference is the rest shape, which is no frame.
    bool reference_is_rest_shape = false;
    /// Passes over all vertices.
    int rounds = 6;
    /// Vertices of the input farther than this from the quads, in edge lengths of the quads, get a
    /// quad vertex of their own: finger tips, ears.
    double distance_limit = 0.4;
};

/// Slides the vertices of a quad mesh over the surface so that quads come closer to squares in all
/// sampled frames at once, and unfolds folded ones. Connectivity and boundary vertices stay. Every
/// move lowers the sum over the sampled frames and the quads around the vertex of squared corner
/// cosines plus a barrier against folding, but for those that cover an extremity or unfold a quad.
/// docs/relaxation.md Throws what `source` throws, and `Cancelled`.
QuadMesh relax_quads(const QuadMesh& quads, const FrameSource& source, const Topology& topology,
                     const IntrinsicMetric& metric, const RelaxOptions& options,
                     const Context& context);

}  // namespace kinequad
