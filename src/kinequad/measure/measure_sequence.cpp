#include "kinequad/measure/measure_sequence.h"

#include <fmt/format.h>

#include <limits>

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

SequenceMetrics measure_sequence(const FrameSource& input, const QuadSequence& quads,
                                 const std::optional<StretchReference>& reference,
                                 const MeasureOptions& options, const Context& context) {
    check_frames(input, quads, options);
    SequenceMetrics result;
    result.has_distance = options.measure_distance;
    result.input = count_mesh(make_polygons(input.triangles()), input.vertex_count());
    std::optional<StretchAlignment> alignment;
    if (reference) alignment.emplace(*reference, context);
    Eigen::Index vertex_count = 0;
    SurfaceDistanceMeter meter(options.distance);
    for (int frame = 0; frame < input.frame_count(); frame += options.frame_step) {
        context.report_progress("measure", double(frame) / input.frame_count());
        const TriangleMesh surface{input.read_frame(frame), input.triangles()};
        const Positions X = quads.read_frame(frame, surface.V);
        if (frame == 0) {
            result.quads = count_mesh(quads.faces, static_cast<int>(X.rows()));
            vertex_count = X.rows();
        }
        check_positions(X, vertex_count, frame);
        FrameMetrics& metrics = result.frames.emplace_back();
        metrics.frame = frame;
        metrics.shape = measure_shape(X, quads.faces);
        if (options.measure_distance) {
            const TriangleMesh cut{X, triangulate_for_measuring(quads.faces, X).F};
            metrics.distance = meter.measure(surface, cut, context);
            metrics.flipped_quads =
                count_flipped_quads(X, quads.faces, *meter.input_surface(), context);
        }
        if (alignment) alignment->add_frame(surface.V, context);
    }
    result.stretch_alignment_degrees =
        alignment ? alignment->degrees() : std::numeric_limits<double>::quiet_NaN();
    context.report_progress("measure", 1);
    return result;
}

}  // namespace kinequad
