#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "commands.h"
#include "input_options.h"
#include "kinequad/core/error.h"
#include "kinequad/io/files.h"
#include "kinequad/io/frame_sink.h"
#include "kinequad/io/read_polygon_mesh.h"
#include "kinequad/pipeline/compare_methods.h"
#include "kinequad/pipeline/make_report.h"
#include "output_folder.h"
#include "report_options.h"

namespace kinequad::app {
namespace {

struct CompareCommand {
    InputOptions input_options;
    ReportOptions report_options;
    Options base;
    MeasureOptions measure;
    std::string input;
    std::string output;
    std::string landmarks;
    std::string reference = "0";
    std::vector<std::string> also;
    bool quads = false;
    bool json = false;
};

ForeignMesh read_foreign(const std::string& argument) {
    const std::size_t equals = argument.find('=');
    require(equals != std::string::npos && equals > 0 && equals + 1 < argument.size(),
            InputFault::usage, fmt::format("--also {}: has to be NAME=FILE", argument));
    PolygonMesh mesh = read_polygon_mesh(argument.substr(equals + 1));
    return {argument.substr(0, equals), std::move(mesh.faces), std::move(mesh.V)};
}

/// A file name for the method `number` called `name`: letters and digits, others as dashes.
std::string file_name(std::size_t number, const std::string& name) {
    std::string text = fmt::format("{}-", number);
    for (const char c : name) {
        const bool is_plain =
            (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        if (is_plain || text.back() != '-') text += is_plain ? c : '-';
    }
    while (text.size() > 1 && text.back() == '-') text.pop_back();
    return text;
}

/// Writes the quads of every method in every frame to the subfolder `quads`.
void write_quads(const ComparisonResult& result, const FrameSource& source, OutputFolder& output,
                 const Context& context) {
    const Positions rest =
        source.has_rest_shape() ? source.read_rest_shape() : source.read_frame(0);
    for (std::size_t i = 0; i < result.meshes.size(); ++i) {
        const QuadSequence& mesh = result.meshes[i];
        const auto sink = create_frame_sink(
            output.path("quads"), file_name(i + 1, result.comparison.methods[i].name),
            SequenceFormat::pc2, mesh.faces, source.frame_count(), mesh.read_frame(0, rest));
        for (int frame = 0; frame < source.frame_count(); ++frame) {
            context.report_progress("quads", static_cast<double>(frame) / source.frame_count());
            sink->write_frame(frame, mesh.read_frame(frame, source.read_frame(frame)));
        }
        sink->finish();
    }
}

void compare(const CompareCommand& command, Session& session) {
    const Context context = session.make_context();
    const std::unique_ptr<FrameSource> source = command.input_options.open(command.input);
    Options base = command.base;
    base.reference = parse_reference(command.reference, *source);
    const PictureOptions pictures = command.report_options.pictures(source->frame_count());

    ComparisonOptions options;
    options.reference = base.reference;
    options.measure = command.measure;
    if (!command.landmarks.empty()) {
        options.landmarks = read_landmarks(command.landmarks);
        require_landmarks_fit(*options.landmarks, source->vertex_count());
    }
    options.recipes = comparison_recipes(base, options.landmarks.has_value());
    for (const std::string& argument : command.also) {
        options.foreign.push_back(read_foreign(argument));
    }
    OutputFolder output(command.output);
    const ComparisonResult result = compare_methods(*source, options, context);

    const std::string text = to_json(result.comparison).dump(2) + "\n";
    write_file_atomically(output.path("compare.json"), text);
    write_file_atomically(output.path("compare.csv"), format_comparison_csv(result.comparison));
    write_file_atomically(output.path("frames.csv"), format_frames_csv(result.comparison));
    output.replace_earlier("quads");
    if (command.quads) write_quads(result, *source, output, context);
    output.replace_earlier("report.html");
    if (command.report_options.is_wanted()) {
        write_file_atomically(output.path("report.html"), format_report(make_comparison_report(
                                                              result, *source, pictures, context)));
    }
    context.check_cancelled();
    output.commit();

    session.finish();
    fmt::print("{}", command.json ? text : format_comparison_table(result.comparison));
}

}  // namespace

void add_compare_command(CLI::App& program, Session& session) {
    const auto command = std::make_shared<CompareCommand>();
    CLI::App& app = *program.add_subcommand(
        "compare",
        "Makes quads with and without animation and symmetry, by the paper's method and the "
        "defaults, and measures them side by side");
    app.add_option(
           "INPUT", command->input,
           "Folder or glob of OBJ, PLY or OFF frames, OBJ with a .pc2 or .mdd of the same name "
           "beside it, or a single mesh")
        ->required();
    app.add_option("-o,--output", command->output,
                   "Folder for compare.json, compare.csv, frames.csv and report.html; made where "
                   "it is absent")
        ->required();
    app.add_option("--landmarks", command->landmarks,
                   "JSON file with pairs of mirrored vertices and vertices on the middle line");
    app.add_option("--also", command->also,
                   "Quad mesh of another program in the pose of the reference, as NAME=FILE; it is "
                   "carried through the frames. May be given several times")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    CLI::Option* vertices = app.add_option("--vertices", command->base.vertices,
                                           "Wanted number of quad vertices of every method")
                                ->check(CLI::Range(8, 100'000'000))
                                ->capture_default_str();
    app.add_option("--edge-length", command->base.edge_length,
                   "Wanted edge length of the quads instead, in units of the input")
        ->check(CLI::PositiveNumber)
        ->excludes(vertices);
    app.add_option("--reference", command->reference,
                   "Reference frame, counted from 0, or rest: the OBJ beside a PC2 or MDD cache")
        ->capture_default_str();
    app.add_option("--frame-step", command->measure.frame_step, "Measure every so many frames")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    app.add_flag("--quads", command->quads,
                 "Write the quads of every method too, as OBJ with a PC2 cache, to the subfolder "
                 "quads");
    app.add_flag("--json", command->json, "Print compare.json on stdout instead of the table");
    command->report_options.add_options(app);
    command->input_options.add_options(app);
    session.add_options(app);
    app.callback([command, &session] { compare(*command, session); });
}

}  // namespace kinequad::app
