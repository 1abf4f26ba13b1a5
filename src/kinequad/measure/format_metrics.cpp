#include "kinequad/measure/format_metrics.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

namespace kinequad {
namespace {

enum class Worse { higher, lower };

/// How a measure is read off a frame.
struct Measure {
    std::string_view name;
    std::string_view label;
    std::string_view unit;
    Worse worse;
    bool is_distance;
    double (*value)(const FrameMetrics&);
};

constexpr Measure measures[] = {
    {"angle_deviation_mean", "angle deviation, mean", "degrees", Worse::higher, false,
     [](const FrameMetrics& f) { return f.shape.angle_deviation_mean; }},
    {"angle_deviation_max", "angle deviation, largest", "degrees", Worse::higher, false,
     [](const FrameMetrics& f) { return f.shape.angle_deviation_max; }},
    {"scaled_jacobian_mean", "scaled Jacobian, mean", "", Worse::lower, false,
     [](const FrameMetrics& f) { return f.shape.scaled_jacobian_mean; }},
    {"scaled_jacobian_min", "scaled Jacobian, smallest", "", Worse::lower, false,
     [](const FrameMetrics& f) { return f.shape.scaled_jacobian_min; }},
    {"folded_quads", "folded quads", "", Worse::higher, false,
     [](const FrameMetrics& f) { return double(f.shape.folded_quads); }},
    {"flipped_quads", "flipped quads", "", Worse::higher, true,
     [](const FrameMetrics& f) { return double(f.flipped_quads); }},
    {"hausdorff_percent", "Hausdorff distance", "% diagonal", Worse::higher, true,
     [](const FrameMetrics& f) { return f.distance.hausdorff_percent(); }},
    {"hausdorff_bound_percent", "  proven upper bound", "% diagonal", Worse::higher, true,
     [](const FrameMetrics& f) { return f.distance.hausdorff_bound_percent(); }},
    {"hausdorff_quads_to_input_percent", "  quads to input", "% diagonal", Worse::higher, true,
     [](const FrameMetrics& f) { return f.distance.quads_to_input.hausdorff_percent; }},
    {"hausdorff_input_to_quads_percent", "  input to quads", "% diagonal", Worse::higher, true,
     [](const FrameMetrics& f) { return f.distance.input_to_quads.hausdorff_percent; }},
    {"mean_distance_percent", "mean distance", "% diagonal", Worse::higher, true,
     [](const FrameMetrics& f) { return f.distance.mean_percent(); }},
    {"mean_quads_to_input_percent", "  quads to input", "% diagonal", Worse::higher, true,
     [](const FrameMetrics& f) { return f.distance.quads_to_input.mean_percent; }},
    {"mean_input_to_quads_percent", "  input to quads", "% diagonal", Worse::higher, true,
     [](const FrameMetrics& f) { return f.distance.input_to_quads.mean_percent; }},
};

nlohmann::json counts_to_json(const MeshCounts& counts) {
    return {{"vertices", counts.vertices},
            {"edges", counts.edges},
            {"faces", counts.faces},
            {"quads", counts.quads},
            {"triangles", counts.triangles},
            {"other_faces", counts.other_faces},
            {"quad_percent", counts.quad_percent()},
            {"singular_vertices", counts.irregular_vertices},
            {"singular_percent", counts.irregular_percent()},
            {"boundary_edges", counts.boundary_edges},
            {"boundary_loops", counts.boundary_loops},
            {"non_manifold_edges", counts.non_manifold_edges},
            {"non_manifold_vertices", counts.non_manifold_vertices},
            {"misoriented_edges", counts.misoriented_edges},
            {"components", counts.components},
            {"euler_characteristic", counts.euler_characteristic},
            {"duplicate_faces", counts.duplicate_faces}};
}

std::string format_counts(const SequenceMetrics& metrics) {
    const MeshCounts& a = metrics.quads;
    const MeshCounts& b = metrics.input;
    std::string text = fmt::format("{:<28}{:>12}{:>12}\n", "mesh", "quads", "input");
    const auto add = [&](std::string_view label, int quads, int input) {
        fmt::format_to(std::back_inserter(text), "{:<28}{:>12}{:>12}\n", label, quads, input);
    };
    add("vertices", a.vertices, b.vertices);
    add("faces", a.faces, b.faces);
    fmt::format_to(std::back_inserter(text), "{:<28}{:>12}\n", "  quads",
                   fmt::format("{:.2f} %", a.quad_percent()));
    fmt::format_to(std::back_inserter(text), "{:<28}{:>12}{:>12}\n", "singular vertices",
                   a.irregular_vertices, fmt::format("{:.2f} %", a.irregular_percent()));
    add("Euler characteristic", a.euler_characteristic, b.euler_characteristic);
    add("components", a.components, b.components);
    add("boundary loops", a.boundary_loops, b.boundary_loops);
    add("boundary edges", a.boundary_edges, b.boundary_edges);
    add("non-manifold edges", a.non_manifold_edges, b.non_manifold_edges);
    add("non-manifold vertices", a.non_manifold_vertices, b.non_manifold_vertices);
    add("misoriented edges", a.misoriented_edges, b.misoriented_edges);
    add("duplicate faces", a.duplicate_faces, b.duplicate_faces);
    return text;
}

}  // namespace

std::vector<MeasureSummary> summarize_metrics(const SequenceMetrics& metrics) {
    std::vector<MeasureSummary> result;
    if (metrics.frames.empty()) return result;
    for (const Measure& measure : measures) {
        if (measure.is_distance && !metrics.has_distance) continue;
        MeasureSummary& summary = result.emplace_back();
        summary.name = measure.name;
        summary.label = measure.label;
        summary.unit = measure.unit;
        double sum = 0;
        for (const FrameMetrics& frame : metrics.frames) {
            const double value = measure.value(frame);
            const bool is_worse =
                measure.worse == Worse::higher ? value > summary.worst : value < summary.worst;
            if (summary.values.empty() || is_worse) {
                summary.worst = value;
                summary.worst_frame = frame.frame;
            }
            summary.values.push_back(value);
            sum += value;
        }
        summary.mean = sum / double(metrics.frames.size());
    }
    return result;
}

nlohmann::json to_json(const SequenceMetrics& metrics) {
    nlohmann::json result = counts_to_json(metrics.quads);
    result["input"] = counts_to_json(metrics.input);
    std::vector<int> frames;
    for (const FrameMetrics& frame : metrics.frames) frames.push_back(frame.frame);
    result["frames"] = frames;
    for (const Measure& measure : measures) result[std::string(measure.name)] = nullptr;
    result["mean"] = nlohmann::json::object();
    result["worst"] = nlohmann::json::object();
    for (const MeasureSummary& summary : summarize_metrics(metrics)) {
        const std::string name(summary.name);
        result[name] = summary.values;
        result["mean"][name] = summary.mean;
        result["worst"][name] = {{"value", summary.worst}, {"frame", summary.worst_frame}};
    }
    result["stretch_alignment_degrees"] = nullptr;
    if (std::isfinite(metrics.stretch_alignment_degrees)) {
        result["stretch_alignment_degrees"] = metrics.stretch_alignment_degrees;
    }
    return result;
}

std::string format_metrics_table(const SequenceMetrics& metrics) {
    std::string text = format_counts(metrics);
    fmt::format_to(std::back_inserter(text), "\n{:<28}{:>12}{:>12}{:>8}\n",
                   fmt::format("over {} frame{}", metrics.frames.size(),
                               metrics.frames.size() == 1 ? "" : "s"),
                   "mean", "worst", "frame");
    for (const MeasureSummary& summary : summarize_metrics(metrics)) {
        fmt::format_to(std::back_inserter(text), "{:<28}{:>12.4f}{:>12.4f}{:>8}  {}", summary.label,
                       summary.mean, summary.worst, summary.worst_frame, summary.unit);
        text.erase(text.find_last_not_of(' ') + 1);
        text += '\n';
    }
    if (std::isfinite(metrics.stretch_alignment_degrees)) {
        fmt::format_to(std::back_inserter(text), "{:<28}{:>12.4f}{:>12}{:>8}  {}\n",
                       "stretch alignment", metrics.stretch_alignment_degrees, "", "",
                       "degrees (22.5: none)");
    }
    return text;
}

}  // namespace kinequad
