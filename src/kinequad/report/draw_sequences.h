#pragma once

#include <string>
#include <vector>

#include "kinequad/core/context.h"
#include "kinequad/io/frame_source.h"
#include "kinequad/measure/measure_sequence.h"
#include "kinequad/report/camera.h"
#include "kinequad/report/format_report.h"

namespace kinequad {

/// A mesh that is drawn in chosen frames of the input.
struct DrawnSequence {
    std::string name;
    QuadSequence mesh;
};

/// Which pictures a report shows.
struct PictureOptions {
    std::vector<int> frames;  ///< empty: four spread over the sequence
    Viewpoint viewpoint;
    int pixels = 420'000;  ///< of one picture, about
};

/// Throws `InputError` (usage) where a frame of `options` is not one of `frame_count`.
void require_frames_exist(const PictureOptions& options, int frame_count);

/// Draws every mesh in every chosen frame, all pictures at one scale and of one size, those of a
/// frame from the same place. Irregular vertices of quad meshes are marked. Throws as
/// `require_frames_exist` and `render_mesh`, and what the sources throw.
std::vector<ReportPictures> draw_sequences(const FrameSource& input,
                                           const std::vector<DrawnSequence>& sequences,
                                           const PictureOptions& options, const Context& context);

}  // namespace kinequad
