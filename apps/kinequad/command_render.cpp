#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "file_drawings.h"
#include "input_options.h"
#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/io/files.h"
#include "kinequad/report/drawable_polygons.h"
#include "kinequad/report/render_mesh.h"
#include "kinequad/report/render_panels.h"
#include "kinequad/report/write_png.h"
#include "output_folder.h"

namespace kinequad::app {
namespace {

struct RenderCommand {
    InputOptions input_options;
    std::vector<std::string> inputs;
    std::string output;
    std::vector<int> frames = {0};
    std::string view = "quarter";
    std::string up = "y";
    std::vector<int> size = {1920, 1080};
    int turntable = 0;
    bool animation = false;
    int frame_step = 1;
    bool plain = false;
    bool no_markers = false;
    std::string mirror;
    std::string symmetry;
    std::string field;

    Viewpoint viewpoint() const { return named_viewpoint(view, up == "z" ? UpAxis::z : UpAxis::y); }
};

/// A mesh or sequence to be drawn: what is the same in all of its frames.
struct DrawnInput {
    std::unique_ptr<FrameSource> source;
    RenderScene scene;  ///< without positions
    std::string symmetry;
    std::string field;

    RenderPanel panel(int frame, const Camera& camera) const {
        RenderPanel result{scene, camera, ""};
        result.scene.V = source->read_frame(frame);
        if (!symmetry.empty()) {
            result.scene.curves = draw_symmetry(symmetry, scene.polygons, result.scene.V).curves;
        }
        if (!field.empty()) {
            const auto lines = draw_streamlines(field, scene.polygons, result.scene.V);
            result.scene.curves.insert(result.scene.curves.end(), lines.begin(), lines.end());
        }
        return result;
    }
};

std::vector<DrawnInput> open_inputs(const RenderCommand& command) {
    std::vector<DrawnInput> inputs;
    for (const std::string& name : command.inputs) {
        DrawnInput& input = inputs.emplace_back();
        input.source = command.input_options.open(name);
        const Polygons faces = input.source->polygons();
        input.scene.polygons = drawable_polygons(faces);
        if (all_faces_have(faces, 4) && !command.no_markers) {
            input.scene.markers =
                mark_irregular_vertices(input.scene.polygons, input.source->vertex_count());
        }
        if (!command.mirror.empty()) {
            input.scene.polygon_colors = color_mirrored_quads(command.mirror, input.scene.polygons,
                                                              input.source->read_frame(0));
        }
        input.field = command.field;
        if (!command.symmetry.empty()) {
            input.symmetry = command.symmetry;
            input.scene.polygon_colors =
                draw_symmetry(command.symmetry, input.scene.polygons, input.source->read_frame(0))
                    .colors;
        }
    }
    return inputs;
}

/// For a picture with panels in `columns` and `rows`, where dots are as large as a panel bears.
RenderOptions options_of(const RenderCommand& command, std::size_t columns, std::size_t rows) {
    RenderOptions options;
    options.width = command.size[0];
    options.height = command.size[1];
    options.draw_edges = !command.plain;
    const double panel = std::min(options.width / static_cast<double>(columns),
                                  options.height / static_cast<double>(rows));
    if (!command.field.empty()) options.curve_width = 1.5;
    options.marker_radius = std::clamp(panel / 160, 2.5, 6.0);
    return options;
}

void require_frame(const DrawnInput& input, int frame) {
    require(frame < input.source->frame_count(), InputFault::usage,
            fmt::format("--frame {}: {} has frames 0 to {}", frame, input.source->name(),
                        input.source->frame_count() - 1));
}

/// One camera for all panels, so that they can be compared.
Camera common_camera(const std::vector<DrawnInput>& inputs, const std::vector<int>& frames,
                     const Viewpoint& viewpoint, const Context& context) {
    std::optional<Camera> camera;
    for (const DrawnInput& input : inputs) {
        for (const int frame : frames) {
            context.check_cancelled();
            const Camera own = fit_camera(input.source->read_frame(frame), viewpoint);
            camera = camera ? unite_cameras(*camera, own) : own;
        }
    }
    return *camera;
}

/// One picture: a row a mesh, a column a frame.
void render_still(const RenderCommand& command, const Context& context) {
    const std::vector<DrawnInput> inputs = open_inputs(command);
    for (const DrawnInput& input : inputs) {
        for (const int frame : command.frames) require_frame(input, frame);
    }
    const Camera camera = common_camera(inputs, command.frames, command.viewpoint(), context);
    std::vector<RenderPanel> panels;
    for (const DrawnInput& input : inputs) {
        for (const int frame : command.frames) panels.push_back(input.panel(frame, camera));
    }
    write_png(command.output,
              render_panels(panels, static_cast<int>(command.frames.size()),
                            options_of(command, command.frames.size(), inputs.size()), context));
}

/// The pictures of a film one after the other, the meshes of each side by side.
void write_pictures(const RenderCommand& command, int count, const Context& context,
                    const std::function<std::vector<RenderPanel>(int picture)>& panels_of) {
    OutputFolder output(command.output);
    const RenderOptions options = options_of(command, command.inputs.size(), 1);
    for (int picture = 0; picture < count; ++picture) {
        context.report_progress("pictures", static_cast<double>(picture) / count);
        const std::vector<RenderPanel> panels = panels_of(picture);
        write_png(output.path(fmt::format("picture_{:04}.png", picture)),
                  render_panels(panels, static_cast<int>(panels.size()), options, context));
    }
    context.check_cancelled();
    output.commit();
}

void render_turntable(const RenderCommand& command, const Context& context) {
    const std::vector<DrawnInput> inputs = open_inputs(command);
    const int frame = command.frames.front();
    Positions all(0, 3);
    for (const DrawnInput& input : inputs) {
        require_frame(input, frame);
        const Positions V = input.source->read_frame(frame);
        all.conservativeResize(all.rows() + V.rows(), 3);
        all.bottomRows(V.rows()) = V;
    }
    const std::vector<Camera> cameras =
        turntable_cameras(all, command.viewpoint(), command.turntable);
    std::vector<RenderPanel> panels;
    panels.reserve(inputs.size());
    for (const DrawnInput& input : inputs) panels.push_back(input.panel(frame, cameras.front()));
    write_pictures(command, command.turntable, context, [&](int picture) {
        for (RenderPanel& panel : panels) panel.camera = cameras[at(picture)];
        return panels;
    });
}

void render_animation(const RenderCommand& command, const Context& context) {
    const std::vector<DrawnInput> inputs = open_inputs(command);
    int count = inputs.front().source->frame_count();
    for (const DrawnInput& input : inputs) count = std::min(count, input.source->frame_count());
    std::vector<int> frames;
    for (int frame = 0; frame < count; frame += command.frame_step) frames.push_back(frame);
    const Camera camera = common_camera(inputs, frames, command.viewpoint(), context);
    write_pictures(command, static_cast<int>(frames.size()), context, [&](int picture) {
        std::vector<RenderPanel> panels;
        panels.reserve(inputs.size());
        for (const DrawnInput& input : inputs) {
            panels.push_back(input.panel(frames[at(picture)], camera));
        }
        return panels;
    });
}

void render(const RenderCommand& command, const Context& context) {
    const bool is_picture = extension_of(command.output) == ".png";
    if (command.turntable > 0 || command.animation) {
        require(!is_picture, InputFault::usage,
                fmt::format("-o {}: several pictures need a folder", command.output));
        if (command.animation) return render_animation(command, context);
        return render_turntable(command, context);
    }
    require(is_picture, InputFault::usage,
            fmt::format("-o {}: a picture has to be called FILE.png; for a folder of pictures "
                        "give --turntable or --animation",
                        command.output));
    render_still(command, context);
}

}  // namespace

void add_render_command(CLI::App& program, Session& session) {
    const auto command = std::make_shared<RenderCommand>();
    CLI::App& app = *program.add_subcommand(
        "render",
        "Draws meshes or frames of sequences as a PNG picture: a row a mesh, a column a frame; or "
        "as the numbered pictures of a film");
    app.add_option("MESH", command->inputs, "Meshes or sequences, as the INPUT of run")->required();
    app.add_option("-o,--output", command->output,
                   "The picture, FILE.png; with --turntable or --animation a folder for "
                   "picture_0000.png, picture_0001.png, ...")
        ->required();
    app.add_option("--frame", command->frames, "Frames to draw, counted from 0, as 0,12,24")
        ->delimiter(',')
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    app.add_option("--view", command->view, "Seen from: front, back, left, right, top or quarter")
        ->check(CLI::IsMember({"front", "back", "left", "right", "top", "quarter"}))
        ->capture_default_str();
    app.add_option("--up", command->up, "Axis of the data that points up in the picture: y or z")
        ->check(CLI::IsMember({"y", "z"}))
        ->capture_default_str();
    app.add_option("--size", command->size, "Width and height of a picture in pixels, as 1920,1080")
        ->delimiter(',')
        ->expected(2)
        ->check(CLI::Range(16, 16384))
        ->capture_default_str();
    CLI::Option* turntable =
        app.add_option("--turntable", command->turntable,
                       "As many pictures of one frame, once around the up axis, the meshes side by "
                       "side")
            ->check(CLI::Range(1, 100'000));
    CLI::Option* animation =
        app.add_flag("--animation", command->animation,
                     "A picture for every frame, the meshes side by side, from one place")
            ->excludes(turntable);
    app.add_option("--frame-step", command->frame_step, "With --animation: every so many frames")
        ->needs(animation)
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    app.add_flag("--plain", command->plain, "Do not draw the edges");
    app.add_option("--mirror", command->mirror,
                   "The mirror.json beside mirrored quads: colours one half by place, every "
                   "mirrored quad as its partner")
        ->check(CLI::ExistingFile);
    app.add_option("--symmetry", command->symmetry,
                   "The symmetry.json of the surface: draws the line of symmetry and colours one "
                   "side by place, the other by the place of its image")
        ->check(CLI::ExistingFile)
        ->excludes("--mirror");
    app.add_option("--field", command->field,
                   "The field.json of the surface, from run --dump-stages: draws lines along the "
                   "crosses")
        ->check(CLI::ExistingFile);
    app.add_flag(
        "--no-markers", command->no_markers,
        "Do not mark irregular vertices of quad meshes (red: fewer than four quads, blue: more)");
    command->input_options.add_options(app);
    session.add_options(app);
    app.callback([command, &session] { render(*command, session.make_context()); });
}

}  // namespace kinequad::app
