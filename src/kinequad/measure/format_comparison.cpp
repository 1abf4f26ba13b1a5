#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "kinequad/measure/comparison.h"
#include "kinequad/measure/format_metrics.h"

namespace kinequad {
namespace {

using Json = nlohmann::ordered_json;

/// The measures that compare.json has a number a frame of.
constexpr std::string_view listed_measures[] = {"angle_deviation_mean", "hausdorff_percent",
                                                "mean_distance_percent", "scaled_jacobian_min"};

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

/// A field of a CSV line: in quotes where it holds a separator [RFC 4180].
std::string csv_field(std::string_view text) {
    if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"') quoted += '"';
        quoted += c;
    }
    return quoted + '"';
}

/// Columns that `text` takes on a terminal: one a character of UTF-8.
std::size_t columns_of(std::string_view text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string padded(std::string_view text, std::size_t columns, bool to_the_right) {
    const std::size_t width = columns_of(text);
    const std::string blanks(columns > width ? columns - width : 0, ' ');
    return to_the_right ? blanks + std::string(text) : std::string(text) + blanks;
}

}  // namespace

nlohmann::ordered_json to_json(const Comparison& comparison) {
    Json frames = Json::array();
    if (!comparison.methods.empty()) {
        for (const FrameMetrics& frame : comparison.methods.front().metrics.frames) {
            frames.push_back(frame.frame);
        }
    }
    Json methods = Json::array();
    for (const ComparedMethod& method : comparison.methods) {
        const MeshCounts& counts = method.metrics.quads;
        Json& entry = methods.emplace_back(Json{{"name", method.name},
                                                {"vertices", counts.vertices},
                                                {"quads", counts.quads},
                                                {"singular_vertices", counts.irregular_vertices}});
        const std::vector<MeasureSummary> summaries = summarize_metrics(method.metrics);
        for (const std::string_view name : listed_measures) {
            Json& values = entry[std::string(name)] = nullptr;
            for (const MeasureSummary& summary : summaries) {
                if (summary.name == name) values = summary.values;
            }
        }
        entry["stretch_alignment_degrees"] = number(method.metrics.stretch_alignment_degrees);
        entry["symmetry_error_degrees"] = number(method.symmetry_error_degrees);
        entry["cpu_seconds"] = number(method.cpu_seconds);
    }
    return {{"frames", frames}, {"methods", methods}};
}

std::string format_comparison_csv(const Comparison& comparison) {
    const std::vector<ComparisonRow> rows = comparison_rows(comparison);
    std::string text = "name";
    const auto out = std::back_inserter(text);
    for (const ComparisonRow& row : rows) fmt::format_to(out, ",{}", row.key);
    text += '\n';
    for (std::size_t i = 0; i < comparison.methods.size(); ++i) {
        text += csv_field(comparison.methods[i].name);
        for (const ComparisonRow& row : rows) {
            text += ',';
            if (std::isfinite(row.values[i])) fmt::format_to(out, "{}", row.values[i]);
        }
        text += '\n';
    }
    return text;
}

std::string format_frames_csv(const Comparison& comparison) {
    std::string text = "name,frame";
    const auto out = std::back_inserter(text);
    bool is_first = true;
    for (const ComparedMethod& method : comparison.methods) {
        const std::vector<MeasureSummary> summaries = summarize_metrics(method.metrics);
        if (is_first) {
            for (const MeasureSummary& summary : summaries)
                fmt::format_to(out, ",{}", summary.name);
            text += '\n';
        }
        is_first = false;
        for (std::size_t i = 0; i < method.metrics.frames.size(); ++i) {
            fmt::format_to(out, "{},{}", csv_field(method.name), method.metrics.frames[i].frame);
            for (const MeasureSummary& summary : summaries) {
                fmt::format_to(out, ",{}", summary.values[i]);
            }
            text += '\n';
        }
    }
    return text;
}

std::string format_comparison_table(const Comparison& comparison) {
    const std::vector<ComparisonRow> rows = comparison_rows(comparison);
    std::size_t label_columns = 0;
    for (const ComparisonRow& row : rows) {
        label_columns = std::max(label_columns, columns_of(row.label) + columns_of(row.unit) + 3);
    }
    std::vector<std::size_t> columns;
    std::string text = padded("", label_columns, false);
    for (const ComparedMethod& method : comparison.methods) {
        columns.push_back(std::max<std::size_t>(10, columns_of(method.name) + 2));
        text += padded(method.name, columns.back(), true);
    }
    text += '\n';
    for (const ComparisonRow& row : rows) {
        const std::string label =
            row.unit.empty() ? std::string(row.label) : fmt::format("{}, {}", row.label, row.unit);
        text += padded(label, label_columns, false);
        for (std::size_t i = 0; i < row.values.size(); ++i) {
            const std::string value = std::isfinite(row.values[i])
                                          ? fmt::format("{:.{}f}", row.values[i], row.decimals)
                                          : "-";
            text += padded(value, columns[i], true);
        }
        text += '\n';
    }
    return text;
}

}  // namespace kinequad
