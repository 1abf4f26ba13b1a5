#include "kinequad/measure/measure_sequence.h"

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "kinequad/core/error.h"
#include "kinequad/measure/flipped_quads.h"
#include "kinequad/measure/triangulation.h"
#include "kinequad/transfer/bind_to_surface.h"

namespace kinequad {
namespace {

void check_frames(const FrameSource& input, const QuadSequence& quads,
                  const MeasureOptions& options) {
    require(options.frame_step > 0, InputFault::usage, "the frame step must be positive");
    if (quads.frame_count >= 0 && quads.frame_count != input.frame_count()) {
        throw InputError(
            InputFault::mesh,
            fmt::format("the quads have {} frames, {} has {}; give two sequences of the "
                        "same length",
                        quads.frame_count, input.name(), input.frame_count()));
    }
}

void check_positions(const Positions& X, Eigen::Index vertex_count, int frame) {
    if (X.rows() != vertex_count) {
        throw InputError(
            InputFault::mesh,
            fmt::format("the quads have {} vertices in frame {}, {} in frame 0; give frames "
                        "of one mesh",
                        X.rows(), frame, vertex_count));
    }
    if (X.allFinite()) return;
    throw InputError(InputFault::mesh,
                     fmt::format("the quads have a position that is not finite in "
                                 "frame {}; mend the vertex list",
                                 frame));
}

/// Measures one mesh a frame at a time.
class SequenceMeter {
public:
    SequenceMeter(const MeasuredQuads& mesh, const MeshCounts& input, const MeasureOptions& options,
                  const Context& context)
        : mesh_(mesh), meter_(options.distance) {
        result_.input = input;
        result_.has_distance = options.measure_distance;
        if (mesh.reference) alignment_.emplace(*mesh.reference, context);
    }

    /// `surface` is the input in that frame, `V` (n x 3) its positions.
    void add_frame(int frame, const Positions& V, const std::optional<ClosestPoints>& surface,
                   const Context& context) {
        const Polygons& faces = mesh_.quads.faces;
        const Positions X = mesh_.quads.read_frame(frame, V);
        if (result_.frames.empty()) {
            result_.quads = count_mesh(faces, static_cast<int>(X.rows()));
            vertex_count_ = X.rows();
        }
        check_positions(X, vertex_count_, frame);
        FrameMetrics& metrics = result_.frames.emplace_back();
        metrics.frame = frame;
        metrics.shape = measure_shape(X, faces);
        if (surface) {
            const TriangleMesh cut{X, triangulate_for_measuring(faces, X).F};
            metrics.distance = meter_.measure(*surface, cut, context);
            metrics.flipped_quads =
                count_flipped_quads(X, faces, *surface, meter_.nearest_input_triangles(), context);
        }
        if (alignment_) alignment_->add_frame(V, context);
    }

    SequenceMetrics finish() {
        result_.stretch_alignment_degrees =
            alignment_ ? alignment_->degrees() : std::numeric_limits<double>::quiet_NaN();
        return std::move(result_);
    }

private:
    const MeasuredQuads& mesh_;
    SurfaceDistanceMeter meter_;
    std::optional<StretchAlignment> alignment_;
    Eigen::Index vertex_count_ = 0;
    SequenceMetrics result_;
};

}  // namespace

QuadSequence follow_surface(const QuadMesh& quads, const Triangles& F) {
    return follow_surface(make_polygons(quads.Q), quads.vertex, F);
}

QuadSequence follow_surface(const Polygons& faces, const std::vector<SurfacePoint>& vertices,
                            const Triangles& F) {
    return {faces,
            [vertices, F](int, const Positions& V) { return carried_positions(vertices, V, F); },
            -1};
}

QuadSequence follow_frames(const Polygons& faces, const FrameSource& frames) {
    return {faces, [&frames](int frame, const Positions&) { return frames.read_frame(frame); },
            frames.frame_count()};
}

QuadSequence stand_still(const Polygons& faces, const Positions& X) {
    return {faces, [X](int, const Positions&) { return X; }, 1};
}

std::vector<SequenceMetrics> measure_sequences(const FrameSource& input,
                                               const std::vector<MeasuredQuads>& meshes,
                                               const MeasureOptions& options,
                                               const Context& context) {
    for (const MeasuredQuads& mesh : meshes) check_frames(input, mesh.quads, options);
    const MeshCounts input_counts =
        count_mesh(make_polygons(input.triangles()), input.vertex_count());
    std::vector<SequenceMeter> meters;
    meters.reserve(meshes.size());
    for (const MeasuredQuads& mesh : meshes) {
        meters.emplace_back(mesh, input_counts, options, context);
    }
    std::optional<ClosestPoints> surface;
    for (int frame = 0; frame < input.frame_count(); frame += options.frame_step) {
        context.report_progress("measure", double(frame) / input.frame_count());
        const Positions V = input.read_frame(frame);
        if (options.measure_distance && surface) surface->update(V, input.triangles());
        if (options.measure_distance && !surface) surface.emplace(V, input.triangles());
        for (SequenceMeter& meter : meters) meter.add_frame(frame, V, surface, context);
    }
    context.report_progress("measure", 1);
    std::vector<SequenceMetrics> results;
    results.reserve(meters.size());
    for (SequenceMeter& meter : meters) results.push_back(meter.finish());
    return results;
}

SequenceMetrics measure_sequence(const FrameSource& input, const QuadSequence& quads,
                                 const std::optional<StretchReference>& reference,
                                 const MeasureOptions& options, const Context& context) {
    return measure_sequences(input, {{quads, reference}}, options, context).front();
}

}  // namespace kinequad
