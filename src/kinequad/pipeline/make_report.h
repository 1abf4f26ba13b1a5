#pragma once

#include <optional>
#include <string>

#include "kinequad/core/context.h"
#include "kinequad/io/frame_source.h"
#include "kinequad/measure/measure_sequence.h"
#include "kinequad/pipeline/compare_methods.h"
#include "kinequad/pipeline/result.h"
#include "kinequad/report/draw_sequences.h"
#include "kinequad/report/format_report.h"

namespace kinequad {

/// The report of one run: its measures, pictures of the input and the quads, times and options.
/// `digest` is that of the input; `metrics` may be empty. Throws what the source throws,
/// `InputError` (usage) for a frame that there is not, and `Cancelled`.
Report make_run_report(const Result& result, const FrameSource& source, const std::string& digest,
                       const std::optional<SequenceMetrics>& metrics,
                       const PictureOptions& pictures, const Context& context);

/// The report of a comparison. Throws as `make_run_report`.
Report make_comparison_report(const ComparisonResult& result, const FrameSource& source,
                              const PictureOptions& pictures, const Context& context);

}  // namespace kinequad
