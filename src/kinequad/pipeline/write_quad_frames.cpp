#include "kinequad/pipeline/write_quad_frames.h"

#include "kinequad/io/frame_digest.h"
#include "kinequad/transfer/transfer.h"

namespace kinequad {

std::string write_quad_frames(const QuadMesh& quads, const FrameSource& source, FrameSink& sink,
                              const Context& context) {
    FrameDigest digest(source.polygons());
    for (int frame = 0; frame < source.frame_count(); ++frame) {
        context.report_progress("frames", static_cast<double>(frame) / source.frame_count());
        const Positions V = source.read_frame(frame);
        digest.add(frame, V);
        sink.write_frame(frame, quad_positions(quads, V, source.triangles()));
    }
    sink.finish();
    return digest.text();
}

}  // namespace kinequad
