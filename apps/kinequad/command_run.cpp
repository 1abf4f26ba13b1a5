#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "commands.h"
#include "input_options.h"
#include "kinequad/core/error.h"
#include "kinequad/io/feature_lines.h"
#include "kinequad/io/files.h"
#include "kinequad/io/frame_digest.h"
#include "kinequad/io/frame_sink.h"
#include "kinequad/io/landmarks.h"
#include "kinequad/io/repaired_sequence.h"
#include "kinequad/io/write_mesh.h"
#include "kinequad/measure/measure_sequence.h"
#include "kinequad/pipeline/check_input.h"
#include "kinequad/pipeline/dump_stage.h"
#include "kinequad/pipeline/make_report.h"
#include "kinequad/pipeline/quadrangulate.h"
#include "kinequad/pipeline/run_record.h"
#include "kinequad/pipeline/write_quad_frames.h"
#include "kinequad/transfer/transfer.h"
#include "output_folder.h"
#include "print_summary.h"
#include "report_options.h"

namespace kinequad::app {
namespace {

struct RunCommand {
    InputOptions input_options;
    ReportOptions report_options;
    Options options;
    std::string input;
    std::string output;
    std::string symmetry;
    std::string landmarks;
    std::string features;
    std::string field = "convex";
    std::string symmetrisation;
    std::string metric;
    std::string reference = "0";
    std::string format;
    std::string dump_directory;
    bool no_metrics = false;
    bool json = false;
    bool check = false;
    bool repair = false;
};

Options options_of(const RunCommand& command, const FrameSource& source) {
    Options options = command.options;
    if (command.symmetry == "none") options.symmetry = SymmetryMode::none;
    if (command.symmetry == "field") options.symmetry = SymmetryMode::field;
    if (command.symmetry == "exact") options.symmetry = SymmetryMode::exact;
    if (command.field == "paper") options.field = CrossFieldMethod::paper;
    if (command.symmetrisation == "orbits") options.symmetrisation = Symmetrisation::orbits;
    if (command.symmetrisation == "term") options.symmetrisation = Symmetrisation::term;
    if (command.metric == "mean") options.metric = MetricChoice::mean;
    if (command.metric == "reference") options.metric = MetricChoice::reference;
    options.reference = parse_reference(command.reference, source);
    options.metrics = !command.no_metrics;
    if (!command.features.empty()) options.features = read_feature_lines(command.features);
    return options;
}

/// Writes the quads in every frame; returns the digest of the input.
std::string write_frames(const RunCommand& command, const Result& result, const FrameSource& source,
                         OutputFolder& output, const Context& context) {
    for (const char* name : {"quads", "quads.obj", "quads.ply", "quads.pc2", "quads.mdd"}) {
        output.replace_earlier(name);
    }
    const bool is_single = source.frame_count() == 1;
    const std::string name = !command.format.empty() ? command.format : is_single ? "obj" : "pc2";
    const SequenceFormat format = *find_sequence_format(name);
    const bool is_cache = format == SequenceFormat::pc2 || format == SequenceFormat::mdd;
    if (is_single && !is_cache) {
        const Positions V = source.read_frame(0);
        write_mesh(output.path("quads." + name),
                   quad_positions(result.quads, V, source.triangles()), result.quads.Q);
        return compute_digest(source);
    }
    const Positions rest = quad_positions(
        result.quads, source.has_rest_shape() ? source.read_rest_shape() : result.reference,
        source.triangles());
    const auto sink = create_frame_sink(output.path(is_cache ? "" : "quads"), "quads", format,
                                        make_polygons(result.quads.Q), source.frame_count(), rest);
    return write_quad_frames(result.quads, source, *sink, context);
}

SequenceMetrics measure(const Result& result, const FrameSource& source, const Context& context) {
    StretchReference reference;
    reference.V = result.reference;
    reference.F = source.triangles();
    reference.sides = triangle_sides(result.topology, metric_of(result.topology, result.reference));
    reference.X = quad_positions(result.quads, result.reference, source.triangles());
    reference.faces = make_polygons(result.quads.Q);
    return measure_sequence(source, follow_surface(result.quads, source.triangles()), reference, {},
                            context);
}

/// Prints what is found in the mesh; throws, for the exit code, where a run would refuse it.
void check(const RunCommand& command, const FrameSource& source, Session& session,
           const Context& context) {
    const int reference = parse_reference(command.reference, source);
    const Positions V =
        reference == Options::rest_shape ? source.read_rest_shape() : source.read_frame(reference);
    MeshCheckOptions options;
    options.most_crossings = 1000;
    const MeshReport report = check_mesh(source.triangles(), V, options, context);
    session.finish();
    fmt::print("{}", command.json ? make_mesh_record(report, source.name()).dump(2) + "\n"
                                  : format_mesh_report(report, source.name()));
    if (!report.is_accepted()) {
        throw InputError(InputFault::mesh,
                         fmt::format("{}: {}", source.name(), describe_refusals(report).front()));
    }
}

void run(const RunCommand& command, Session& session) {
    const Context context = session.make_context();
    StageClock clock;
    std::vector<StageTime> opening;
    const std::unique_ptr<FrameSource> input = command.input_options.open(command.input);
    std::unique_ptr<RepairedSequence> repaired;
    if (command.repair) {
        repaired = std::make_unique<RepairedSequence>(*input, context);
        for (const std::string& action : repaired->actions()) {
            context.write_log(LogLevel::warning, "repair: " + action);
        }
    }
    const FrameSource* const source = repaired ? repaired.get() : input.get();
    if (command.check) return check(command, *source, session, context);
    require(!command.output.empty(), InputFault::usage, "--output is required; give -o FOLDER");
    const PictureOptions pictures = command.report_options.pictures(source->frame_count());
    OutputFolder output(command.output);
    clock.finish_stage("open", opening);

    StageObserver observe;
    if (!command.dump_directory.empty()) {
        observe = [&](std::string_view stage, const Result& so_far) {
            dump_stage(command.dump_directory, stage, so_far);
        };
    }
    std::optional<Landmarks> landmarks;
    if (!command.landmarks.empty()) {
        landmarks = read_landmarks(command.landmarks);
        require_landmarks_fit(*landmarks, source->vertex_count());
    }
    Result result =
        quadrangulate(*source, landmarks, options_of(command, *source), context, observe);
    result.times.insert(result.times.begin(), opening.begin(), opening.end());

    clock = StageClock();
    const std::string digest = write_frames(command, result, *source, output, context);
    write_file_atomically(
        output.path("binding.json"),
        format_binding(result.quads, repaired ? repaired->input_triangles() : source->triangles()));
    output.replace_earlier("mirror.json");
    if (!result.quads.mirror.empty()) {
        write_file_atomically(output.path("mirror.json"), format_mirror(result.quads));
    }
    clock.finish_stage("frames", result.times);

    std::optional<SequenceMetrics> metrics;
    if (result.options.metrics) {
        metrics = measure(result, *source, context);
        clock.finish_stage("metrics", result.times);
    }
    output.replace_earlier("report.html");
    if (command.report_options.is_wanted()) {
        const Report report = make_run_report(result, *source, digest, metrics, pictures, context);
        write_file_atomically(output.path("report.html"), format_report(report));
        clock.finish_stage("report", result.times);
    }
    nlohmann::ordered_json record = make_run_record(result, *source, digest, metrics);
    if (repaired) record["input"]["repaired"] = repaired->actions();
    if (landmarks) {
        record["options"]["landmarks"] = {{"pairs", landmarks->pairs},
                                          {"stationary", landmarks->stationary}};
    }
    const std::string text = record.dump(2) + "\n";
    write_file_atomically(output.path("run.json"), text);
    context.check_cancelled();
    output.commit();

    session.finish();
    fmt::print("{}",
               command.json ? text : format_run_summary(record, metrics, output.final_path("")));
}

void add_method_options(CLI::App& app, RunCommand& command) {
    Options& options = command.options;
    CLI::Option* vertices =
        app.add_option("--vertices", options.vertices,
                       "Wanted number of quad vertices, mostly met within 5 %; run.json says "
                       "why where it is not within 10 %")
            ->check(CLI::Range(8, 100'000'000))
            ->capture_default_str();
    app.add_option("--edge-length", options.edge_length,
                   "Wanted edge length of the quads instead, in units of the input")
        ->check(CLI::PositiveNumber)
        ->excludes(vertices);
    app.add_option("--landmarks", command.landmarks,
                   "JSON file with pairs of mirrored vertices and vertices on the middle line: "
                   "where left and right of the surface are");
    app.add_option(
           "--symmetry", command.symmetry,
           "How the quads are made symmetric: none; field (the cross field alone); exact "
           "(one half is solved and mirrored). Without landmarks a pose that a plane "
           "mirrors is looked for [exact with landmarks, or field with --field paper; else none]")
        ->check(CLI::IsMember({"none", "field", "exact"}));
    app.add_option(
           "--field", command.field,
           "Recipe of the cross field: convex (fewer singularities, faster) or paper (the energy "
           "and greedy solver of Du and Tu)")
        ->check(CLI::IsMember({"convex", "paper"}))
        ->capture_default_str();
    app.add_option(
           "--symmetrise", command.symmetrisation,
           "How the cross field is made symmetric: term (in one solve) or orbits (solved on "
           "the whole surface, averaged over orbits and solved again, as in the paper) "
           "[the better of both; orbits with --field paper and --symmetry field]")
        ->check(CLI::IsMember({"orbits", "term"}));
    app.add_option(
        "--alpha", options.alpha,
        fmt::format("Influence of the animation, from 0 (see the reference frame only) to below "
                    "1 [{}; the best of five with --symmetry exact, of six with field]",
                    default_alpha(CrossFieldMethod::convex)));
    app.add_option("--curvature", options.curvature, "Influence of the curvature (convex only)")
        ->capture_default_str();
    app.add_option(
           "--feature-angle", options.feature_angle,
           "Edges across which the reference frame turns by more than this many degrees become "
           "chains of quad edges; 0: none")
        ->check(CLI::Range(0.0, 180.0))
        ->capture_default_str();
    app.add_option("--features", command.features,
                   "JSON file with chains of vertices whose edges become chains of quad edges");
    app.add_option(
        "--singularity-cost", options.singularity_cost,
        "Energy that one singularity may cost, in squared radians (convex only) [0.08; 0.1 "
        "with --symmetry exact, 0.2 with --symmetry field where orbits are averaged]");
    app.add_option(
           "--relax", options.relax_rounds,
           "Rounds in which the vertices slide over the surface towards squares, then right "
           "angles; 0: none")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    app.add_option(
           "--metric", command.metric,
           "Edge lengths that the surface is known by: mean (over the frames) or reference "
           "[mean; reference with --alpha 0, with --field paper, and where the frames differ too "
           "much for a mean]")
        ->check(CLI::IsMember({"mean", "reference"}));
    app.add_option("--reference", command.reference,
                   "Reference frame, counted from 0, or rest: the OBJ beside a PC2 or MDD cache")
        ->capture_default_str();
}

}  // namespace

void add_run_command(CLI::App& program, Session& session) {
    const auto command = std::make_shared<RunCommand>();
    CLI::App& app = *program.add_subcommand(
        "run", "Makes one quad mesh for all frames of an animated triangle mesh");
    app.add_option(
           "INPUT", command->input,
           "Folder or glob of OBJ, PLY or OFF frames, OBJ with a .pc2 or .mdd of the same name "
           "beside it, or a single mesh")
        ->required();
    app.add_option(
        "-o,--output", command->output,
        "Folder for the quad sequence, run.json, binding.json and report.html; made where it is "
        "absent");
    app.add_flag("--check", command->check,
                 "Only check the mesh: print what is wrong or remarkable, with element numbers (as "
                 "JSON with --json)");
    app.add_flag(
        "--repair", command->repair,
        "Mend what can be mended without a change of the surface: orientation, repeated and "
        "flat triangles, vertices between several fans");
    add_method_options(app, *command);
    app.add_option(
           "--format", command->format,
           "Of the quad sequence: obj or ply (a file a frame), pc2 or mdd (an OBJ with a cache) "
           "[pc2; obj for a single mesh]")
        ->check(CLI::IsMember({"obj", "ply", "pc2", "mdd"}));
    app.add_flag("--no-metrics", command->no_metrics, "Do not measure the result");
    app.add_flag("--json", command->json, "Print run.json on stdout instead of the summary");
    app.add_option("--dump-stages", command->dump_directory,
                   "Folder for what each stage made, as JSON, for inspection");
    command->report_options.add_options(app);
    command->input_options.add_options(app);
    session.add_options(app);
    app.callback([command, &session] { run(*command, session); });
}

}  // namespace kinequad::app
