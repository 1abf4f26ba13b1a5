#include "kinequad/measure/comparison.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

namespace kinequad {
namespace {

/// Metrics with the given angle deviation and Hausdorff distance a frame.
SequenceMetrics metrics_of(const std::vector<double>& angle, const std::vector<double>& hausdorff) {
    SequenceMetrics metrics;
    metrics.quads.vertices = 200;
    metrics.quads.quads = 198;
    metrics.quads.irregular_vertices = 8;
    metrics.stretch_alignment_degrees = 20.5;
    for (std::size_t i = 0; i < angle.size(); ++i) {
        FrameMetrics& frame = metrics.frames.emplace_back();
        frame.frame = 10 * static_cast<int>(i);
        frame.shape.angle_deviation_mean = angle[i];
        frame.shape.scaled_jacobian_min = 0.5 - 0.1 * static_cast<double>(i);
        frame.distance.quads_to_input.hausdorff_percent = hausdorff[i];
        frame.distance.quads_to_input.mean_percent = 0.01;
        frame.distance.input_to_quads.mean_percent = 0.02;
    }
    return metrics;
}

Comparison two_methods() {
    Comparison comparison;
    comparison.methods.push_back(
        {"base", "The baseline.", metrics_of({8, 9, 10}, {0.5, 0.6, 0.7}), 19, 2.5});
    comparison.methods.push_back(
        {"ours, \"new\"", "Another.", metrics_of({7, 9, 8}, {0.5, 0.5, 0.8})});
    comparison.baseline = 0;
    return comparison;
}

const ComparisonRow& row_of(const std::vector<ComparisonRow>& rows, std::string_view key) {
    const auto found =
        std::find_if(rows.begin(), rows.end(), [&](const auto& row) { return row.key == key; });
    if (found == rows.end()) throw std::logic_error("no row " + std::string(key));
    return *found;
}

TEST(Comparison, RowsHoldCountsMeansAndWorstFrames) {
    const auto rows = comparison_rows(two_methods());
    EXPECT_EQ(row_of(rows, "singular_vertices").values, (std::vector<double>{8, 8}));
    EXPECT_EQ(row_of(rows, "singular_percent").values, (std::vector<double>{4, 4}));
    EXPECT_EQ(row_of(rows, "angle_deviation_degrees_mean").values, (std::vector<double>{9, 8}));
    EXPECT_EQ(row_of(rows, "angle_deviation_degrees_worst").values, (std::vector<double>{10, 9}));
    EXPECT_NEAR(row_of(rows, "scaled_jacobian_min_mean").values[0], 0.4, 1e-12);
    EXPECT_NEAR(row_of(rows, "scaled_jacobian_min_worst").values[0], 0.3, 1e-12);
    EXPECT_EQ(row_of(rows, "mean_distance_percent_mean").values[0], 0.02);
    EXPECT_EQ(row_of(rows, "symmetry_error_degrees").values[0], 19);
    EXPECT_TRUE(std::isnan(row_of(rows, "symmetry_error_degrees").values[1]));
    EXPECT_TRUE(std::isnan(row_of(rows, "cpu_seconds").values[1]));
}

TEST(Comparison, CountsFramesAgainstTheBaseline) {
    const auto rows = comparison_rows(two_methods());
    const auto& angle = row_of(rows, "frames_with_smaller_angle_percent").values;
    EXPECT_TRUE(std::isnan(angle[0]));
    EXPECT_NEAR(angle[1], 200.0 / 3, 1e-9);  // 9 is not below 9
    EXPECT_NEAR(row_of(rows, "frames_with_hausdorff_not_above_percent").values[1], 200.0 / 3,
                1e-9);  // 0.5 is not above 0.5
    Comparison without = two_methods();
    without.baseline = -1;
    EXPECT_LT(comparison_rows(without).size(), rows.size());
    EXPECT_TRUE(std::isnan(percent_of_frames_below(metrics_of({1}, {1}), metrics_of({1, 2}, {1, 2}),
                                                   "hausdorff_percent", true)));
}

TEST(Comparison, JsonHoldsExactlyTheKeysOfItsFormat) {
    const nlohmann::ordered_json json = to_json(two_methods());
    EXPECT_EQ(json.size(), 2U);
    EXPECT_EQ(json["frames"], (nlohmann::ordered_json{0, 10, 20}));
    std::vector<std::string> keys;
    for (const auto& [key, value] : json["methods"][0].items()) keys.push_back(key);
    EXPECT_EQ(keys, (std::vector<std::string>{
                        "name", "vertices", "quads", "singular_vertices", "angle_deviation_mean",
                        "hausdorff_percent", "mean_distance_percent", "scaled_jacobian_min",
                        "stretch_alignment_degrees", "symmetry_error_degrees", "cpu_seconds"}));
    EXPECT_EQ(json["methods"][0]["angle_deviation_mean"], (nlohmann::ordered_json{8.0, 9.0, 10.0}));
    EXPECT_EQ(json["methods"][0]["cpu_seconds"], 2.5);
    EXPECT_EQ(json["methods"][1]["name"], "ours, \"new\"");
    EXPECT_TRUE(json["methods"][1]["symmetry_error_degrees"].is_null());
    Comparison shape_only = two_methods();
    shape_only.methods[0].metrics.has_distance = false;
    EXPECT_TRUE(to_json(shape_only)["methods"][0]["hausdorff_percent"].is_null());
    EXPECT_FALSE(to_json(shape_only)["methods"][0]["angle_deviation_mean"].is_null());
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = text.find('\n', at);
        lines.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    return lines;
}

TEST(Comparison, CsvQuotesNamesAndLeavesUnknownFieldsEmpty) {
    const std::vector<std::string> lines = lines_of(format_comparison_csv(two_methods()));
    ASSERT_EQ(lines.size(), 3U);
    EXPECT_EQ(lines[0].rfind("name,vertices,quads,singular_vertices,singular_percent,", 0), 0U);
    EXPECT_EQ(lines[1].rfind("base,200,198,8,4,9,10,", 0), 0U) << lines[1];
    EXPECT_EQ(lines[2].rfind("\"ours, \"\"new\"\"\",200,", 0), 0U) << lines[2];
    EXPECT_NE(lines[2].find(",,20.5,,"), std::string::npos) << lines[2];
}

TEST(Comparison, FramesCsvHasALineAMethodAndFrame) {
    const std::vector<std::string> lines = lines_of(format_frames_csv(two_methods()));
    ASSERT_EQ(lines.size(), 7U);
    EXPECT_EQ(lines[0].rfind("name,frame,angle_deviation_mean,", 0), 0U);
    EXPECT_EQ(lines[2].rfind("base,10,9,", 0), 0U) << lines[2];
}

TEST(Comparison, TableLinesUpItsColumns) {
    const std::vector<std::string> lines = lines_of(format_comparison_table(two_methods()));
    const auto width = [](const std::string& line) {
        return std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xC0) != 0x80; });
    };
    for (const std::string& line : lines) EXPECT_EQ(width(line), width(lines[0])) << line;
    EXPECT_NE(lines[0].find("ours, \"new\""), std::string::npos);
}

}  // namespace
}  // namespace kinequad
