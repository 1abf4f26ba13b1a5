#pragma once

#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "kinequad/measure/measure_sequence.h"

namespace kinequad {

/// One way to make quads for an animation, and what it gave.
struct ComparedMethod {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

    std::string name;         ///< short and unique
    std::string description;  ///< one sentence
    SequenceMetrics metrics;
    /// See `measure_symmetry_error`; not a number where no symmetry map is known.
    double symmetry_error_degrees = unknown;
    /// CPU time that making the quads took, without measuring them, all threads together; not a
    /// number for a mesh that was given.
    double cpu_seconds = unknown;
};

/// Methods side by side, all measured in the same frames of the same input.
struct Comparison {
    std::vector<ComparedMethod> methods;
    /// The method that the others are compared with frame by frame; -1 for none.
    int baseline = -1;
};

/// One line of the table of a comparison.
struct ComparisonRow {
    enum class Better { lower, higher, neither };

    std::string_view key;    ///< name in CSV, with the unit
    std::string_view label;  ///< for a reader
    std::string_view unit;   ///< may be empty
    Better better = Better::neither;
    int decimals = 0;
    std::vector<double> values;  ///< one a method; not a number where unknown
};

/// The lines of the table: counts as in the paper's Table 1, mean over the frames and worst frame
/// of the measures, symmetry error, stretch alignment, and CPU time; with a baseline also in how
/// many frames a method is better. Lines that are unknown for all methods are left out.
/// docs/measures.md
std::vector<ComparisonRow> comparison_rows(const Comparison& comparison);

/// Share of the frames, in percent, in which the measure `name` (as in `MeasureSummary`) of
/// `metrics` is below that of `baseline`, or not above it where `or_equal`. Not a number where one
/// of them has no such measure, or other frames.
double percent_of_frames_below(const SequenceMetrics& metrics, const SequenceMetrics& baseline,
                               std::string_view name, bool or_equal);

/// compare.json: `{"frames": [...], "methods": [{"name", "vertices", "quads", "singular_vertices",
/// "angle_deviation_mean", "hausdorff_percent", "mean_distance_percent", "scaled_jacobian_min"
/// (each a list with a number a frame), "stretch_alignment_degrees", "symmetry_error_degrees",
/// "cpu_seconds"}, ...]}`. What is unknown is null.
nlohmann::ordered_json to_json(const Comparison& comparison);

/// The table as CSV [RFC 4180]: a line a method, a column a row of `comparison_rows`; unknown
/// values are empty.
std::string format_comparison_csv(const Comparison& comparison);

/// The measures of every frame as CSV: a line a method and frame.
std::string format_frames_csv(const Comparison& comparison);

/// The table for a terminal: a column a method, a newline at the end.
std::string format_comparison_table(const Comparison& comparison);

}  // namespace kinequad
