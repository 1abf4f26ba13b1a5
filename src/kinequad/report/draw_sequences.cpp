#include "kinequad/report/draw_sequences.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kinequad/core/error.h"
#include "kinequad/report/drawable_polygons.h"
#include "kinequad/report/render_mesh.h"

namespace kinequad {
namespace {

std::vector<int> frames_of(const PictureOptions& options, int frame_count) {
    if (!options.frames.empty()) return options.frames;
    std::vector<int> frames;
    constexpr int wanted = 4;
    for (int k = 0; k < std::min(wanted, frame_count); ++k) {
        const int steps = std::min(wanted, frame_count) - 1;
        frames.push_back(steps > 0 ? (2 * k * (frame_count - 1) + steps) / (2 * steps) : 0);
    }
    return frames;
}

/// A picture of about `pixels` pixels with the sides of the camera's box.
RenderOptions options_for(const Camera& camera, int pixels) {
    RenderOptions options;
    options.margin = 0.03;
    const double aspect = std::clamp(camera.half_width / camera.half_height, 0.4, 2.5);
    options.width = std::max(16, static_cast<int>(std::lround(std::sqrt(pixels * aspect))));
    options.height = std::max(16, static_cast<int>(std::lround(std::sqrt(pixels / aspect))));
    options.marker_radius = 4.5;
    options.edge_width = 1.0;
    return options;
}

}  // namespace

void require_frames_exist(const PictureOptions& options, int frame_count) {
    for (const int frame : options.frames) {
        if (frame >= 0 && frame < frame_count) continue;
        throw InputError(InputFault::usage,
                         fmt::format("there is no frame {} to draw; the input has frames 0 to {}",
                                     frame, frame_count - 1));
    }
}

std::vector<ReportPictures> draw_sequences(const FrameSource& input,
                                           const std::vector<DrawnSequence>& sequences,
                                           const PictureOptions& options, const Context& context) {
    require_frames_exist(options, input.frame_count());
    const std::vector<int> frames = frames_of(options, input.frame_count());
    std::vector<Positions> poses;
    std::vector<Camera> cameras;
    double half_width = 0;
    double half_height = 0;
    for (const int frame : frames) {
        poses.push_back(input.read_frame(frame));
        cameras.push_back(fit_camera(poses.back(), options.viewpoint));
        half_width = std::max(half_width, cameras.back().half_width);
        half_height = std::max(half_height, cameras.back().half_height);
    }
    std::vector<ReportPictures> pictures;
    pictures.reserve(frames.size());
    for (const int frame : frames) pictures.push_back({frame, {}});
    for (std::size_t s = 0; s < sequences.size(); ++s) {
        const DrawnSequence& sequence = sequences[s];
        RenderScene scene;
        scene.polygons = drawable_polygons(sequence.mesh.faces);
        const bool all_quads = all_faces_have(sequence.mesh.faces, 4);
        for (std::size_t i = 0; i < frames.size(); ++i) {
            context.report_progress("pictures",
                                    static_cast<double>(s * frames.size() + i) /
                                        static_cast<double>(sequences.size() * frames.size()));
            scene.V = sequence.mesh.read_frame(frames[i], poses[i]);
            if (all_quads && i == 0) {
                scene.markers =
                    mark_irregular_vertices(scene.polygons, static_cast<int>(scene.V.rows()));
            }
            cameras[i].half_width = half_width;
            cameras[i].half_height = half_height;
            pictures[i].panels.emplace_back(
                sequence.name,
                render_mesh(scene, cameras[i], options_for(cameras[i], options.pixels), context));
        }
    }
    return pictures;
}

}  // namespace kinequad
