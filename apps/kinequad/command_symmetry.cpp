#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "commands.h"
#include "input_options.h"
#include "kinequad/io/files.h"
#include "kinequad/io/landmarks.h"
#include "kinequad/pipeline/find_symmetry.h"
#include "kinequad/pipeline/solve_quads.h"
#include "kinequad/symmetry/format_symmetry_json.h"

namespace kinequad::app {
namespace {

struct SymmetryCommand {
    InputOptions input_options;
    std::string input;
    std::string landmarks;
    std::string output;
    std::string reference = "0";
    std::string metric = "mean";
};

void print_quality(const FoundSymmetry& found, const std::string& output) {
    fmt::print("method                       {}\n", found.map.method);
    fmt::print("p to S(S(p)), mean, largest  {:.4f} {:.4f} % of the diagonal\n",
               found.report.involution_mean_percent, found.report.involution_max_percent);
    fmt::print("stationary curve             {} closed, {} from boundary to boundary\n",
               found.report.stationary_loops, found.report.stationary_paths);
    fmt::print("reversed triangles           {}\n", found.map.quality.reversed_triangles);
    fmt::print("file                         {}\n", output);
}

void find(const SymmetryCommand& command, Session& session) {
    const Context context = session.make_context();
    const std::unique_ptr<FrameSource> source = command.input_options.open(command.input);
    std::optional<Landmarks> landmarks;
    if (!command.landmarks.empty()) landmarks = read_landmarks(command.landmarks);
    const Positions reference =
        read_reference(*source, parse_reference(command.reference, *source));
    const Topology topology = build_topology(source->triangles(), source->vertex_count());
    const MetricChoice choice =
        command.metric == "reference" ? MetricChoice::reference : MetricChoice::mean;
    const IntrinsicMetric metric = choose_metric(*source, topology, reference, choice, context);
    const FoundSymmetry found = find_symmetry(*source, metric, landmarks, reference, context);
    write_file_atomically(command.output, format_symmetry_json(found.map));
    session.finish();
    print_quality(found, command.output);
}

}  // namespace

void add_symmetry_command(CLI::App& program, Session& session) {
    const auto command = std::make_shared<SymmetryCommand>();
    CLI::App& app = *program.add_subcommand(
        "symmetry", "Finds the left-right symmetry map of an animated triangle mesh");
    app.add_option(
           "INPUT", command->input,
           "Folder or glob of OBJ, PLY or OFF frames, OBJ with a .pc2 or .mdd of the same name "
           "beside it, or a single mesh")
        ->required();
    app.add_option(
        "--landmarks", command->landmarks,
        "JSON file with pairs of mirrored vertices and vertices on the middle line; without "
        "it, a pose that a plane mirrors is looked for");
    app.add_option("-o,--output", command->output, "JSON file for the map")->required();
    app.add_option(
           "--reference", command->reference,
           "Frame in which distances are reported, counted from 0, or rest: the OBJ beside a "
           "PC2 or MDD cache")
        ->capture_default_str();
    app.add_option("--metric", command->metric,
                   "Edge lengths that the surface is known by: mean (over the frames) or reference")
        ->check(CLI::IsMember({"mean", "reference"}))
        ->capture_default_str();
    command->input_options.add_options(app);
    session.add_options(app);
    app.callback([command, &session] { find(*command, session); });
}

}  // namespace kinequad::app
