#pragma once

#include <optional>
#include <vector>

#include "kinequad/core/context.h"
#include "kinequad/extract/quad_mesh.h"
#include "kinequad/io/frame_source.h"
#include "kinequad/mesh/intrinsic_metric.h"

namespace kinequad {

struct RelaxOptions {
    /// Frames of each view whose quads are looked at, evenly chosen, beside the reference where
    /// that is none of them. At least 1.
    int sampled_frames = 8;
    /// Frames of each view in which gaps are closed once more at the end, so that poses between the
    /// sampled ones count; nothing happens where they are no more than those.
    int settling_frames = 0;
    /// Passes over all vertices between these last gaps.
    int settling_rounds = 8;
    /// Frames of each view that `settle_in_more_frames` looks at, those of them, at most, in which
    /// shapes of quads count, and its passes over all vertices.
    int watched_frames = 0;
    int shaped_frames = 64;
    int watched_rounds = 8;
    /// The reference is this frame, which is not looked at twice; empty where it is no frame.
    std::optional<int> reference_frame = 0;
    /// Passes over all vertices, of each kind.
    int rounds = 8;
    /// Vertices of the input farther than this from the quads, in edge lengths of the quads, get a
    /// quad vertex of their own while quads slide: finger tips, ears. At last `gap_limit` counts.
    double distance_limit = 0.4;
    /// At last quads and input are brought closer together where they are farther apart than most
    /// of this in any sampled frame, in edge lengths of the quads. `settle_in_more_frames` takes
    /// more where quads are so far away that most could not come as close.
    double gap_limit = 0.45;
    /// Whether patches of quads move as one there, where no vertex alone brings them closer.
    bool drags_patches = false;
    /// Edges of lines of the surface, such as the line of symmetry or features: quad vertices on
    /// them slide along them.
    std::vector<int> line_edges = {};
};

/// An animation that quads are relaxed in, and the pose of it in which none may stay folded.
struct RelaxView {
    const FrameSource& frames;
    Positions reference;  ///< n x 3
};

/// Slides the vertices of a quad mesh over the surface so that quads come closer to squares in all
/// sampled frames at once, and unfolds folded ones. Connectivity stays, and so do boundary
/// vertices, but along `line_edges`.
///
/// Passes towards squares and right angles lower, move by move, the sum over the sampled frames and
/// the quads around the vertex of squared corner cosines, a barrier against folding and a little
/// for the lengths of sides. What unfolds quads, covers extremities or brings quads and input
/// closer together in other ways may raise it.
///
/// `views` are animations of the same triangles: one, or the two sides of a symmetric surface. Each
/// reference counts about a quarter as much as the frames that go with it. docs/relaxation.md
/// Throws what the sources throw, and `Cancelled`.
QuadMesh relax_quads(const QuadMesh& quads, const std::vector<RelaxView>& views,
                     const Topology& topology, const IntrinsicMetric& metric,
                     const RelaxOptions& options, const Context& context);

/// Closes gaps between relaxed quads and the input in up to `watched_frames` of each view, evenly
/// chosen, so that no pose between those that `relax_quads` has seen leaves the input by more:
/// shapes of quads count in up to `shaped_frames` of them, the references no more than the rest.
/// Then, where nearly all gaps close, a lower limit is reached for, and what comes of it is kept if
/// it is worth it; at last what is farthest in a frame comes closer. Arguments, result and
/// exceptions as there. docs/relaxation.md
QuadMesh settle_in_more_frames(const QuadMesh& quads, const std::vector<RelaxView>& views,
                               const Topology& topology, const IntrinsicMetric& metric,
                               const RelaxOptions& options, const Context& context);

}  // namespace kinequad
