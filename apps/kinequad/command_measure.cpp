#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "commands.h"
#include "input_options.h"
#include "kinequad/core/error.h"
#include "kinequad/measure/format_metrics.h"
#include "kinequad/measure/measure_sequence.h"
#include "kinequad/transfer/bind_to_surface.h"

namespace kinequad::app {
namespace {

struct MeasureCommand {
    InputOptions input_options;
    std::string quads;
    std::string input;
    std::string reference = "0";
    MeasureOptions options;
    bool no_distance = false;
    bool json = false;
};

/// Stretch is measured on the input's own triangles, whose connectivity need not be a manifold.
StretchReference make_stretch_reference(const FrameSource& input, const Positions& V,
                                        const Positions& X, const Polygons& faces) {
    StretchReference reference;
    reference.V = V;
    reference.F = input.triangles();
    reference.sides.resize(reference.F.rows(), 3);
    for (Eigen::Index t = 0; t < reference.F.rows(); ++t) {
        for (int k = 0; k < 3; ++k) {
            reference.sides(t, k) =
                (V.row(reference.F(t, (k + 1) % 3)) - V.row(reference.F(t, k))).norm();
        }
    }
    reference.X = X;
    reference.faces = faces;
    return reference;
}

SequenceMetrics measure(const MeasureCommand& command, const Context& context) {
    const std::unique_ptr<FrameSource> quads = command.input_options.open(command.quads);
    const std::unique_ptr<FrameSource> input = command.input_options.open(command.input);
    const int reference = parse_reference(command.reference, *input);
    const Positions V = read_reference(*input, reference);
    const Polygons faces = quads->polygons();
    MeasureOptions options = command.options;
    options.measure_distance = !command.no_distance;
    const bool has_frames = quads->frame_count() == input->frame_count();
    if (!has_frames && quads->frame_count() != 1) {
        throw InputError(
            InputFault::mesh,
            fmt::format("{} has {} frames, {} has {}; give as many, or a single mesh in the "
                        "pose of --reference",
                        command.quads, quads->frame_count(), command.input, input->frame_count()));
    }
    if (has_frames) {
        const bool rest_pair = reference < 0 && quads->has_rest_shape();
        require(reference >= 0 || rest_pair, InputFault::usage,
                fmt::format("--reference rest: {} has no rest shape; name a frame", command.quads));
        const Positions X = read_reference(*quads, reference);
        return measure_sequence(*input, follow_frames(faces, *quads),
                                make_stretch_reference(*input, V, X, faces), options, context);
    }
    const Positions X = quads->read_frame(0);
    const auto points = bind_to_surface(X, V, input->triangles(), context);
    return measure_sequence(*input, follow_surface(faces, points, input->triangles()),
                            make_stretch_reference(*input, V, X, faces), options, context);
}

}  // namespace

void add_measure_command(CLI::App& program, Session& session) {
    const auto command = std::make_shared<MeasureCommand>();
    CLI::App& app = *program.add_subcommand(
        "measure",
        "Measures any quad mesh or sequence, ours or not, against the animation it stands for");
    app.add_option(
           "QUADS", command->quads,
           "Quad mesh in as many frames as the input, or in one pose, whose vertices are then "
           "carried along by the nearest points of the input; formats as INPUT of run")
        ->required();
    app.add_option("--against", command->input,
                   "The animated triangle mesh; formats as INPUT of run")
        ->required();
    app.add_option(
           "--reference", command->reference,
           "Frame of the input (or rest) in which a single pose is, and against which stretch is "
           "measured")
        ->capture_default_str();
    app.add_option("--frame-step", command->options.frame_step, "Measure every so many frames")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    app.add_option(
           "--spacing", command->options.distance.spacing_percent,
           "Largest distance of a point of a surface from a sample on it, in % of the diagonal of "
           "the input's bounding box")
        ->check(CLI::Range(0.01, 100.0))
        ->capture_default_str();
    app.add_flag("--no-distance", command->no_distance,
                 "Leave out distances, which take most of the time");
    app.add_flag("--json", command->json, "Print JSON with every frame instead of a table");
    command->input_options.add_options(app);
    session.add_options(app);
    app.callback([command, &session] {
        const SequenceMetrics metrics = measure(*command, session.make_context());
        session.finish();
        fmt::print("{}",
                   command->json ? to_json(metrics).dump(2) + "\n" : format_metrics_table(metrics));
    });
}

}  // namespace kinequad::app
