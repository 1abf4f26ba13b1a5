#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "kinequad/measure/measure_sequence.h"

namespace kinequad {

/// One measure over the frames.
struct MeasureSummary {
    std::string_view name;  ///< as in the JSON, with the unit at its end where there is one
    std::string_view label;
    std::string_view unit;
    std::vector<double> values;  ///< a frame measured
    double mean = 0;
    double worst = 0;
    int worst_frame = 0;
};

/// All measures of a sequence, in the order of the table. Empty where no frame was measured.
std::vector<MeasureSummary> summarize_metrics(const SequenceMetrics& metrics);

/// The measures as JSON: counts of the mesh, `input` with those of the input, `frames`, a list for
/// each measure with a number a frame, and `mean` and `worst` of each. What was not measured is
/// null.
nlohmann::json to_json(const SequenceMetrics& metrics);

/// The measures as a table for a terminal, with a newline at the end.
std::string format_metrics_table(const SequenceMetrics& metrics);

}  // namespace kinequad
