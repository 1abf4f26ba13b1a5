#include "kinequad/pipeline/make_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "kinequad/measure/symmetry_error.h"
#include "kinequad/pipeline/run_record.h"
#include "kinequad/pipeline/solve_quads.h"
#include "kinequad/pipeline/solved_input.h"
#include "kinequad/pipeline/version.h"

namespace kinequad {
namespace {

std::string footer() {
    return fmt::format(
        "Made by Kinequad {}. This page needs no network; it is safe to keep and to send.",
        version);
}

/// The last part of the input's path.
std::string short_name(const FrameSource& source) {
    const std::filesystem::path path(source.name());
    const std::filesystem::path last = path.has_filename() ? path : path.parent_path();
    return last.stem().empty() ? source.name() : last.stem().string();
}

/// Digits in groups of three, as 19,938.
std::string grouped(std::size_t number) {
    const std::string digits = std::to_string(number);
    std::string text;
    for (std::size_t i = 0; i < digits.size(); ++i) {
        if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
        text += digits[i];
    }
    return text;
}

/// A value as text; of a list its length.
std::string cell_of(const nlohmann::ordered_json& value) {
    if (value.is_array()) return std::to_string(value.size());
    if (value.is_string()) return value.get<std::string>();
    if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
    if (value.is_number_integer()) return std::to_string(value.get<long long>());
    if (value.is_number()) return fmt::format("{:g}", value.get<double>());
    return "–";
}

std::string spaced(std::string name) {
    std::replace(name.begin(), name.end(), '_', ' ');
    return name;
}

std::vector<ReportFact> facts_of_input(const FrameSource& source) {
    return {{"input", short_name(source)},
            {"frames", grouped(static_cast<std::size_t>(source.frame_count()))},
            {"vertices", grouped(static_cast<std::size_t>(source.vertex_count()))},
            {"triangles", grouped(static_cast<std::size_t>(source.triangles().rows()))}};
}

/// One column of options; rows that others have and this one lacks stay empty.
void add_options(const std::string& name, const Options& options, ReportTable& table) {
    const nlohmann::ordered_json record = make_options_record(options);
    for (const auto& [key, value] : record.items()) {
        const std::string label = spaced(key);
        auto row = std::find_if(table.rows.begin(), table.rows.end(),
                                [&](const ReportTable::Row& r) { return r.label == label; });
        if (row == table.rows.end()) row = table.rows.insert(row, {label, {}});
        row->cells.resize(table.columns.size(), "–");
        row->cells.push_back(cell_of(value));
    }
    table.columns.push_back(name);
}

void add_cpu_times(const std::string& name, const std::vector<StageTime>& times,
                   ReportTable& table) {
    for (const StageTime& time : times) {
        auto row = std::find_if(table.rows.begin(), table.rows.end(),
                                [&](const ReportTable::Row& r) { return r.label == time.stage; });
        if (row == table.rows.end()) row = table.rows.insert(row, {time.stage, {}});
        row->cells.resize(table.columns.size(), "–");
        row->cells.push_back(fmt::format("{:.2f}", time.cpu_seconds));
    }
    table.columns.push_back(name);
    for (ReportTable::Row& row : table.rows) row.cells.resize(table.columns.size(), "–");
}

ReportTable wall_and_cpu_times(const std::vector<StageTime>& times) {
    ReportTable table{{"wall, s", "CPU, s"}, {}};
    double wall = 0;
    double cpu = 0;
    const auto add = [&](const std::string& label, double wall_seconds, double cpu_seconds) {
        table.rows.push_back(
            {label, {fmt::format("{:.2f}", wall_seconds), fmt::format("{:.2f}", cpu_seconds)}});
    };
    for (const StageTime& time : times) {
        add(time.stage, time.wall_seconds, time.cpu_seconds);
        wall += time.wall_seconds;
        cpu += time.cpu_seconds;
    }
    add("total", wall, cpu);
    return table;
}

/// Error of the quads against the symmetry that the run made use of.
double symmetry_error_of(const Result& result, const QuadSequence& quads, const FrameSource& source,
                         const Context& context) {
    const SolvedInput input(source, result.topology, result.reference, result.refined);
    const IntrinsicMetric metric = choose_metric(
        input.frames(), input.topology(), input.reference(), *result.options.metric, context);
    const StretchReference reference{input.reference(), input.frames().triangles(),
                                     triangle_sides(input.topology(), metric),
                                     quads.read_frame(0, result.reference), quads.faces};
    return measure_symmetry_error(reference, result.symmetry->map, context);
}

}  // namespace

Report make_run_report(const Result& result, const FrameSource& source, const std::string& digest,
                       const std::optional<SequenceMetrics>& metrics,
                       const PictureOptions& pictures, const Context& context) {
    Report report;
    const QuadSequence quads = follow_surface(result.quads, source.triangles());
    report.title = short_name(source) + ": one quad mesh for all frames";
    report.lead = fmt::format("{} quads over {} frame{}, made and measured by Kinequad.",
                              grouped(static_cast<std::size_t>(result.quads.Q.rows())),
                              source.frame_count(), source.frame_count() == 1 ? "" : "s");
    report.facts = facts_of_input(source);
    report.facts.emplace_back("quad vertices", grouped(result.quads.vertex.size()));
    report.facts.emplace_back("quads", grouped(static_cast<std::size_t>(result.quads.Q.rows())));
    report.facts.emplace_back("edge length", fmt::format("{:.4g}", result.edge_length));
    report.facts.emplace_back("version", version);
    report.facts.emplace_back("digest of the input", digest);

    ComparedMethod method{"kinequad", "", {}};
    method.metrics.has_distance = false;
    method.metrics.quads = count_mesh(quads.faces, static_cast<int>(result.quads.vertex.size()));
    method.metrics.stretch_alignment_degrees = ComparedMethod::unknown;
    if (metrics) method.metrics = *metrics;
    if (metrics && result.symmetry) {
        method.symmetry_error_degrees = symmetry_error_of(result, quads, source, context);
    }
    method.cpu_seconds = 0;
    for (const StageTime& time : result.times) {
        if (time.stage != "metrics") method.cpu_seconds += time.cpu_seconds;
    }
    report.comparison.methods.push_back(std::move(method));
    report.highlighted = 0;
    report.pictures = draw_sequences(
        source,
        {{"input", follow_frames(make_polygons(source.triangles()), source)}, {"quads", quads}},
        pictures, context);
    report.times = wall_and_cpu_times(result.times);
    add_options("value", result.options, report.options);
    report.footer = footer();
    return report;
}

Report make_comparison_report(const ComparisonResult& result, const FrameSource& source,
                              const PictureOptions& pictures, const Context& context) {
    Report report;
    const std::vector<ComparedMethod>& methods = result.comparison.methods;
    report.title = short_name(source) + ": methods compared";
    report.lead = fmt::format(
        "{} quad meshes of the same animation, each measured in {} frames against the input.",
        methods.size(), methods.front().metrics.frames.size());
    report.facts = facts_of_input(source);
    report.facts.emplace_back("version", version);
    report.comparison = result.comparison;
    std::vector<DrawnSequence> drawn;
    for (std::size_t i = 0; i < methods.size(); ++i) {
        drawn.push_back({methods[i].name, result.meshes[i]});
        if (!result.options[i]) continue;
        // The last recipe is Kinequad with its defaults.
        report.highlighted = static_cast<int>(i);
        add_options(methods[i].name, *result.options[i], report.options);
        add_cpu_times(methods[i].name, result.times[i], report.times);
    }
    report.pictures = draw_sequences(source, drawn, pictures, context);
    report.footer = footer();
    return report;
}

}  // namespace kinequad
