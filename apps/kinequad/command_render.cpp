#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "commands.h"
#include "input_options.h"
#include "kinequad/core/error.h"
#include "kinequad/report/render_mesh.h"
#include "kinequad/report/render_panels.h"
#include "kinequad/report/write_png.h"

namespace kinequad::app {
namespace {

struct RenderCommand {
    InputOptions input_options;
    std::vector<std::string> inputs;
    std::string output;
    std::vector<int> frames = {0};
    std::string view = "quarter";
    std::string up = "y";
    std::vector<int> size = {1600, 1200};
    bool plain = false;
    bool no_markers = false;
};

/// The faces as rows of four where all have at most four corners, else cut into triangles.
Quads drawable_polygons(const FrameSource& source) {
    const Polygons faces = source.polygons();
    Quads rows(faces.count(), 4);
    for (int f = 0; f < faces.count(); ++f) {
        const auto corners = faces[f];
        if (corners.size() > 4) return polygons_of(source.triangles());
        rows(f, 3) = -1;
        for (std::size_t k = 0; k < corners.size(); ++k) rows(f, static_cast<int>(k)) = corners[k];
    }
    return rows;
}

/// One panel a frame of one input, without its camera yet.
std::vector<RenderPanel> make_panels(const RenderCommand& command, const std::string& input) {
    const std::unique_ptr<FrameSource> source = command.input_options.open(input);
    const Quads polygons = drawable_polygons(*source);
    const bool all_quads = (polygons.col(3).array() >= 0).all();
    std::vector<RenderPanel> panels;
    for (const int frame : command.frames) {
        require(frame < source->frame_count(), InputFault::usage,
                fmt::format("--frame {}: {} has frames 0 to {}", frame, input,
                            source->frame_count() - 1));
        RenderPanel& panel = panels.emplace_back();
        panel.scene.V = source->read_frame(frame);
        panel.scene.polygons = polygons;
        if (all_quads && !command.no_markers) {
            panel.scene.markers = mark_irregular_vertices(polygons, source->vertex_count());
        }
    }
    return panels;
}

/// One camera for all panels, so that they can be compared.
Camera common_camera(const std::vector<RenderPanel>& panels, const RenderCommand& command) {
    Eigen::Index rows = 0;
    for (const RenderPanel& panel : panels) rows += panel.scene.V.rows();
    Positions all(rows, 3);
    rows = 0;
    for (const RenderPanel& panel : panels) {
        all.middleRows(rows, panel.scene.V.rows()) = panel.scene.V;
        rows += panel.scene.V.rows();
    }
    return fit_camera(all,
                      named_viewpoint(command.view, command.up == "z" ? UpAxis::z : UpAxis::y));
}

void render(const RenderCommand& command, const Context& context) {
    std::vector<RenderPanel> panels;
    for (const std::string& input : command.inputs) {
        for (RenderPanel& panel : make_panels(command, input)) panels.push_back(std::move(panel));
    }
    const Camera camera = common_camera(panels, command);
    for (RenderPanel& panel : panels) panel.camera = camera;
    RenderOptions options;
    options.width = command.size[0];
    options.height = command.size[1];
    options.draw_edges = !command.plain;
    write_png(command.output,
              render_panels(panels, static_cast<int>(command.frames.size()), options, context));
}

}  // namespace

void add_render_command(CLI::App& program, Session& session) {
    const auto command = std::make_shared<RenderCommand>();
    CLI::App& app = *program.add_subcommand(
        "render",
        "Draws meshes or frames of sequences as a PNG picture: a row a mesh, a column a frame");
    app.add_option("MESH", command->inputs, "Meshes or sequences, as the INPUT of run")->required();
    app.add_option("-o,--output", command->output, "The picture, FILE.png")->required();
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
    app.add_option("--size", command->size,
                   "Width and height of the picture in pixels, as 1600,1200")
        ->delimiter(',')
        ->expected(2)
        ->check(CLI::Range(16, 16384))
        ->capture_default_str();
    app.add_flag("--plain", command->plain, "Do not draw the edges");
    app.add_flag(
        "--no-markers", command->no_markers,
        "Do not mark irregular vertices of quad meshes (red: fewer than four quads, blue: more)");
    command->input_options.add_options(app);
    session.add_options(app);
    app.callback([command, &session] { render(*command, session.make_context()); });
}

}  // namespace kinequad::app
