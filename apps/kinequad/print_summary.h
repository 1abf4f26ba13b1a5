#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "kinequad/measure/measure_sequence.h"

namespace kinequad::app {

/// A run for a reader on a terminal: what went in, what came out, metrics and times. `record` is
/// that of `make_run_record`, `folder` where the files are.
std::string format_run_summary(const nlohmann::ordered_json& record,
                               const std::optional<SequenceMetrics>& metrics,
                               const std::filesystem::path& folder);

}  // namespace kinequad::app
