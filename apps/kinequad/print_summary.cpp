#include "print_summary.h"

#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>

#include "kinequad/measure/format_metrics.h"

namespace kinequad::app {

std::string format_run_summary(const nlohmann::ordered_json& record,
                               const std::optional<SequenceMetrics>& metrics,
                               const std::filesystem::path& folder) {
    std::string text;
    const auto out = std::back_inserter(text);
    const auto& input = record["input"];
    fmt::format_to(out, "input   {}: {} frames, {} vertices, {} triangles\n",
                   input["name"].get<std::string>(), input["frames"].get<int>(),
                   input["vertices"].get<int>(), input["triangles"].get<int>());
    fmt::format_to(out, "quads   {} vertices, {} quads, {} singularities in the field\n",
                   record["quads"]["vertices"].get<int>(), record["quads"]["quads"].get<int>(),
                   record["field"]["singularities"].get<int>());
    const auto& symmetry = record["symmetry"];
    if (!symmetry.is_null()) {
        fmt::format_to(out, "mirror  {} map, p to S(S(p)) {:.3f} % of the diagonal in the mean\n",
                       symmetry["method"].get<std::string>(),
                       symmetry["involution_mean_percent"].get<double>());
    }
    fmt::format_to(out, "folder  {}\n\n", folder.string());
    if (metrics) fmt::format_to(out, "{}\n", format_metrics_table(*metrics));
    fmt::format_to(out, "{:<14}{:>10}{:>10}\n", "stage", "wall s", "CPU s");
    for (const auto& stage : record["stages"]) {
        fmt::format_to(out, "{:<14}{:>10.2f}{:>10.2f}\n", stage["stage"].get<std::string>(),
                       stage["wall_seconds"].get<double>(), stage["cpu_seconds"].get<double>());
    }
    const auto& total = record["total"];
    fmt::format_to(out, "{:<14}{:>10.2f}{:>10.2f}\n", "total", total["wall_seconds"].get<double>(),
                   total["cpu_seconds"].get<double>());
    return text;
}

}  // namespace kinequad::app
