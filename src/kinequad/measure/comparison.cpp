#include "kinequad/measure/comparison.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "kinequad/measure/format_metrics.h"

namespace kinequad {
namespace {

using Better = ComparisonRow::Better;

/// A measure of the frames that the table summarises, by its name in `MeasureSummary`.
struct FrameMeasure {
    std::string_view name;
    std::string_view mean_key, mean_label, worst_key, worst_label, unit;
    Better better;
    int decimals;
};

constexpr FrameMeasure frame_measures[] = {
    {"angle_deviation_mean", "angle_deviation_degrees_mean", "angle deviation, mean",
     "angle_deviation_degrees_worst", "angle deviation, worst frame", "°", Better::lower, 2},
    {"hausdorff_percent", "hausdorff_percent_mean", "Hausdorff distance, mean",
     "hausdorff_percent_worst", "Hausdorff distance, worst frame", "% diagonal", Better::lower, 3},
    {"mean_distance_percent", "mean_distance_percent_mean", "mean distance, mean",
     "mean_distance_percent_worst", "mean distance, worst frame", "% diagonal", Better::lower, 4},
    {"scaled_jacobian_mean", "scaled_jacobian_mean_mean", "scaled Jacobian, mean",
     "scaled_jacobian_mean_worst", "scaled Jacobian, worst frame", "", Better::higher, 4},
    {"scaled_jacobian_min", "scaled_jacobian_min_mean", "smallest scaled Jacobian, mean",
     "scaled_jacobian_min_worst", "smallest scaled Jacobian, worst frame", "", Better::higher, 3},
    {"folded_quads", "folded_quads_mean", "folded quads, mean", "folded_quads_worst",
     "folded quads, worst frame", "", Better::lower, 1},
};

/// Summaries of one method's measures by name; null where it was not measured.
const MeasureSummary* find_summary(const std::vector<MeasureSummary>& summaries,
                                   std::string_view name) {
    const auto found = std::find_if(summaries.begin(), summaries.end(),
                                    [&](const MeasureSummary& s) { return s.name == name; });
    return found == summaries.end() ? nullptr : &*found;
}

class RowList {
public:
    explicit RowList(const Comparison& comparison) : comparison_(comparison) {}

    void add(std::string_view key, std::string_view label, std::string_view unit, Better better,
             int decimals, const std::function<double(std::size_t)>& value_of) {
        ComparisonRow row{key, label, unit, better, decimals, {}};
        for (std::size_t i = 0; i < comparison_.methods.size(); ++i) {
            row.values.push_back(value_of(i));
        }
        if (std::any_of(row.values.begin(), row.values.end(),
                        [](double value) { return std::isfinite(value); })) {
            rows_.push_back(std::move(row));
        }
    }

    std::vector<ComparisonRow> take() { return std::move(rows_); }

private:
    const Comparison& comparison_;
    std::vector<ComparisonRow> rows_;
};

}  // namespace

double percent_of_frames_below(const SequenceMetrics& metrics, const SequenceMetrics& baseline,
                               std::string_view name, bool or_equal) {
    const auto own = summarize_metrics(metrics);
    const auto other = summarize_metrics(baseline);
    const MeasureSummary* a = find_summary(own, name);
    const MeasureSummary* b = find_summary(other, name);
    if (a == nullptr || b == nullptr || a->values.size() != b->values.size()) {
        return ComparedMethod::unknown;
    }
    int count = 0;
    for (std::size_t i = 0; i < a->values.size(); ++i) {
        const bool below = or_equal ? a->values[i] <= b->values[i] : a->values[i] < b->values[i];
        count += below ? 1 : 0;
    }
    return 100.0 * count / static_cast<double>(a->values.size());
}

std::vector<ComparisonRow> comparison_rows(const Comparison& comparison) {
    const std::vector<ComparedMethod>& methods = comparison.methods;
    RowList rows(comparison);
    const auto add_count = [&](std::string_view key, std::string_view label, Better better,
                               int MeshCounts::*count) {
        rows.add(key, label, "", better, 0,
                 [&, count](std::size_t i) { return double(methods[i].metrics.quads.*count); });
    };
    add_count("vertices", "vertices", Better::neither, &MeshCounts::vertices);
    add_count("quads", "quads", Better::neither, &MeshCounts::quads);
    add_count("singular_vertices", "singular vertices", Better::lower,
              &MeshCounts::irregular_vertices);
    rows.add("singular_percent", "proportion", "%", Better::lower, 2,
             [&](std::size_t i) { return methods[i].metrics.quads.irregular_percent(); });

    std::vector<std::vector<MeasureSummary>> summaries;
    summaries.reserve(methods.size());
    for (const ComparedMethod& method : methods) {
        summaries.push_back(summarize_metrics(method.metrics));
    }
    for (const FrameMeasure& measure : frame_measures) {
        const auto value_of = [&](double MeasureSummary::*member) {
            return [&, member](std::size_t i) {
                const MeasureSummary* summary = find_summary(summaries[i], measure.name);
                return summary == nullptr ? ComparedMethod::unknown : summary->*member;
            };
        };
        rows.add(measure.mean_key, measure.mean_label, measure.unit, measure.better,
                 measure.decimals, value_of(&MeasureSummary::mean));
        rows.add(measure.worst_key, measure.worst_label, measure.unit, measure.better,
                 measure.decimals, value_of(&MeasureSummary::worst));
    }

    rows.add("symmetry_error_degrees", "symmetry error", "°", Better::lower, 2,
             [&](std::size_t i) { return methods[i].symmetry_error_degrees; });
    rows.add("stretch_alignment_degrees", "stretch alignment", "°", Better::lower, 2,
             [&](std::size_t i) { return methods[i].metrics.stretch_alignment_degrees; });
    rows.add("cpu_seconds", "CPU time", "s", Better::lower, 2,
             [&](std::size_t i) { return methods[i].cpu_seconds; });

    if (comparison.baseline >= 0) {
        const auto baseline = static_cast<std::size_t>(comparison.baseline);
        const auto below = [&](std::string_view name, bool or_equal) {
            return [&, name, or_equal](std::size_t i) {
                return i == baseline
                           ? ComparedMethod::unknown
                           : percent_of_frames_below(methods[i].metrics, methods[baseline].metrics,
                                                     name, or_equal);
            };
        };
        rows.add("frames_with_smaller_angle_percent", "frames with smaller angle", "%",
                 Better::higher, 1, below("angle_deviation_mean", false));
        rows.add("frames_with_hausdorff_not_above_percent", "frames with Hausdorff not above", "%",
                 Better::higher, 1, below("hausdorff_percent", true));
    }
    return rows.take();
}

}  // namespace kinequad
