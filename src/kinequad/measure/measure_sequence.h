#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "kinequad/core/context.h"
#include "kinequad/extract/quad_mesh.h"
#include "kinequad/io/frame_source.h"
#include "kinequad/io/polygons.h"
#include "kinequad/measure/mesh_counts.h"
#include "kinequad/measure/quad_shape.h"
#include "kinequad/measure/stretch_alignment.h"
#include "kinequad/measure/surface_distance.h"

namespace kinequad {

/// A quad mesh in every frame of an animation, ours or not.
struct QuadSequence {
    Polygons faces;
    /// Positions (v x 3) in frame `frame` of the input, whose vertex positions in it are `V` (n x
    /// 3).
    std::function<Positions(int frame, const Positions& V)> read_frame;
    /// Number of frames; -1 where the quads follow any number of frames of the input.
    int frame_count = -1;
};

/// A quad mesh tied to the surface of the input, whose triangles are `F` (m x 3).
QuadSequence follow_surface(const QuadMesh& quads, const Triangles& F);
/// A foreign mesh tied to the surface of the input by `bind_to_surface`.
QuadSequence follow_surface(const Polygons& faces, const std::vector<SurfacePoint>& vertices,
                            const Triangles& F);
/// A foreign mesh with its own frames: `frames` gives the positions, `faces` the faces over them.
/// `frames` has to outlive the result.
QuadSequence follow_frames(const Polygons& faces, const FrameSource& frames);
/// A foreign mesh in a single pose, `X` v x 3, for an input of one frame.
QuadSequence stand_still(const Polygons& faces, const Positions& X);

/// What `measure_sequence` measures.
struct MeasureOptions {
    int frame_step = 1;            ///< every how many frames one is measured, from the first on
    bool measure_distance = true;  ///< false: shape alone, which takes a hundredth of the time
    DistanceOptions distance;
};

/// The measures of one frame.
struct FrameMetrics {
    int frame = 0;
    QuadShapeMetrics shape;
    int flipped_quads = 0;  ///< see `count_flipped_quads`; 0 where distances are not measured
    SurfaceDistance distance;
};

/// The measures of a quad mesh over an animation. docs/measures.md
struct SequenceMetrics {
    MeshCounts quads;  ///< of the mesh measured
    MeshCounts input;
    bool has_distance = true;
    std::vector<FrameMetrics> frames;
    /// See `StretchAlignment`; not a number where it was not asked for or nothing is stretched.
    double stretch_alignment_degrees = 0;
};

/// One of several quad meshes that are measured together.
struct MeasuredQuads {
    QuadSequence quads;
    /// Where stretch alignment is measured.
    std::optional<StretchReference> reference;
};

/// Measures several quad meshes against the same `input`, frame by frame, holding one frame in
/// memory; each frame is read and made ready for searches once. Returns one result a mesh, the same
/// as if it was measured alone. Throws `InputError` (mesh) where the two do not have the same
/// number of frames, the faces do not fit the vertices or a position is not finite; (usage) where
/// `frame_step` is not positive; `Cancelled`; and what the sources throw.
std::vector<SequenceMetrics> measure_sequences(const FrameSource& input,
                                               const std::vector<MeasuredQuads>& meshes,
                                               const MeasureOptions& options = {},
                                               const Context& context = {});

/// Measures one quad mesh. Stretch alignment is measured where `reference` is given. Throws as
/// `measure_sequences`.
SequenceMetrics measure_sequence(const FrameSource& input, const QuadSequence& quads,
                                 const std::optional<StretchReference>& reference = {},
                                 const MeasureOptions& options = {}, const Context& context = {});

}  // namespace kinequad
