#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "commands.h"
#include "input_options.h"
#include "kinequad/core/error.h"
#include "kinequad/io/files.h"
#include "kinequad/io/frame_sink.h"
#include "kinequad/io/write_mesh.h"
#include "output_folder.h"

namespace kinequad::app {
namespace {

struct ConvertCommand {
    InputOptions input_options;
    std::string input;
    std::string output;
    std::string format = "obj";
    int frame = -1;
};

void write_single_frame(const FrameSource& source, int frame, const std::filesystem::path& output) {
    require(
        frame < source.frame_count(), InputFault::usage,
        fmt::format("--frame {}: the input has frames 0 to {}", frame, source.frame_count() - 1));
    write_mesh(output, source.read_frame(frame), source.polygons());
}

void write_sequence(const FrameSource& source, const std::filesystem::path& folder,
                    const std::string& stem, SequenceFormat format, const Context& context) {
    OutputFolder output(folder);
    const Positions rest =
        source.has_rest_shape() ? source.read_rest_shape() : source.read_frame(0);
    const auto sink = create_frame_sink(output.path(""), stem, format, source.polygons(),
                                        source.frame_count(), rest);
    for (int frame = 0; frame < source.frame_count(); ++frame) {
        context.report_progress("convert", static_cast<double>(frame) / source.frame_count());
        sink->write_frame(frame, source.read_frame(frame));
    }
    sink->finish();
    output.commit();
}

/// What frames in `folder` are called: as the folder is, however it is written.
std::string stem_in(const std::filesystem::path& folder) {
    std::filesystem::path path = std::filesystem::absolute(folder).lexically_normal();
    if (!path.has_filename()) path = path.parent_path();
    const std::string stem = path.stem().string();
    return stem.empty() ? "frame" : stem;
}

void convert(const ConvertCommand& command, const Context& context) {
    const std::unique_ptr<FrameSource> source = command.input_options.open(command.input);
    const std::filesystem::path output = command.output;
    const std::string extension = extension_of(output);
    const bool is_cache = extension == ".pc2" || extension == ".mdd";
    if (command.frame >= 0 || (!extension.empty() && !is_cache && source->frame_count() == 1)) {
        write_single_frame(*source, std::max(command.frame, 0), output);
    } else if (is_cache) {
        write_sequence(*source, output.parent_path().empty() ? "." : output.parent_path(),
                       output.stem().string(), *find_sequence_format(extension.substr(1)), context);
    } else {
        require(
            extension.empty(), InputFault::usage,
            fmt::format(
                "{}: holds one frame, but {} has {}; name a folder, a .pc2 or .mdd file, or one "
                "--frame",
                command.output, command.input, source->frame_count()));
        const std::filesystem::path folder = output.has_filename() ? output : output.parent_path();
        write_sequence(*source, folder, stem_in(folder), *find_sequence_format(command.format),
                       context);
    }
}

}  // namespace

void add_convert_command(CLI::App& program, Session& session) {
    const auto command = std::make_shared<ConvertCommand>();
    CLI::App& app = *program.add_subcommand("convert", "Converts between the formats of sequences");
    app.add_option(
           "IN", command->input,
           "Folder or glob of OBJ, PLY or OFF frames, OBJ with a .pc2 or .mdd of the same name "
           "beside it, or a single mesh")
        ->required();
    app.add_option("OUT", command->output,
                   "FILE.pc2 or FILE.mdd (an OBJ is written beside it), a folder of frames, or for "
                   "a single "
                   "frame FILE.obj, FILE.ply or FILE.off")
        ->required();
    app.add_option("--format", command->format, "Of the frames in a folder: obj, ply, pc2 or mdd")
        ->check(CLI::IsMember({"obj", "ply", "pc2", "mdd"}))
        ->capture_default_str();
    app.add_option("--frame", command->frame, "Convert this frame only, counted from 0")
        ->check(CLI::NonNegativeNumber);
    command->input_options.add_options(app);
    session.add_options(app);
    app.callback([command, &session] { convert(*command, session.make_context()); });
}

}  // namespace kinequad::app
