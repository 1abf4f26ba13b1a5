#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "commands.h"
#include "kinequad/io/files.h"
#include "kinequad/io/frame_sink.h"
#include "kinequad/synth/synthesize_creature.h"
#include "output_folder.h"

namespace kinequad::app {
namespace {

struct SynthCommand {
    SynthOptions options;
    std::string name;
    std::string output;
    std::string format = "pc2";
};

void synthesize(const SynthCommand& command, Session& session) {
    const Context context = session.make_context();
    const std::unique_ptr<SyntheticCreature> creature =
        synthesize_creature(command.name, command.options, context);
    OutputFolder output(command.output);
    const auto sink = create_frame_sink(output.path(""), command.name,
                                        *find_sequence_format(command.format), creature->polygons(),
                                        creature->frame_count(), creature->read_rest_shape());
    for (int frame = 0; frame < creature->frame_count(); ++frame) {
        context.report_progress("frames", static_cast<double>(frame) / creature->frame_count());
        sink->write_frame(frame, creature->read_frame(frame));
    }
    sink->finish();
    const nlohmann::json mirror = {{"mirror", creature->mirror()}};
    write_file_atomically(output.path("mirror.json"), mirror.dump() + "\n");
    const nlohmann::json landmarks = {{"pairs", creature->landmarks().pairs},
                                      {"stationary", creature->landmarks().stationary}};
    write_file_atomically(output.path("landmarks.json"), landmarks.dump() + "\n");
    context.check_cancelled();
    output.commit();
    session.finish();
    fmt::print("{}: {} frames, {} vertices, {} triangles\n", output.final_path("").string(),
               creature->frame_count(), creature->vertex_count(), creature->triangles().rows());
}

}  // namespace

void add_synth_command(CLI::App& program, Session& session) {
    const auto command = std::make_shared<SynthCommand>();
    CLI::App& app = *program.add_subcommand("synth",
                                            "Makes an animated example creature: mirror-symmetric "
                                            "at rest, walking, and in no frame in a "
                                            "symmetric pose");
    app.add_option("NAME", command->name, "Which creature")
        ->required()
        ->check(CLI::IsMember(list_creatures()));
    app.add_option(
           "-o,--output", command->output,
           "Folder for the sequence, mirror.json (the true mirror vertex of every vertex) and "
           "landmarks.json; made where it is absent")
        ->required();
    app.add_option("--triangles", command->options.triangle_count,
                   "Number of triangles, met within 10 %")
        ->check(CLI::Range(1000, 4'000'000))
        ->capture_default_str();
    app.add_option("--frames", command->options.frame_count, "Frames of one cycle of the motion")
        ->check(CLI::Range(1, 100'000))
        ->capture_default_str();
    app.add_option("--format", command->format,
                   "obj or ply (a file a frame), pc2 or mdd (an OBJ at rest with a cache)")
        ->check(CLI::IsMember({"obj", "ply", "pc2", "mdd"}))
        ->capture_default_str();
    session.add_options(app);
    app.callback([command, &session] { synthesize(*command, session); });
}

}  // namespace kinequad::app
