// Prints a Markdown table of runs: `kinequad_table DIR...`, each a folder that `kinequad run` has
// left.

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "kinequad/io/files.h"

namespace {

using Json = nlohmann::json;

/// The reference frame is the first of those measured, unless the run names another.
double in_reference_frame(const Json& record, const char* measure) {
    const Json& reference = record["options"]["reference"];
    const std::size_t frame = reference.is_number() ? reference.get<std::size_t>() : 0;
    return record["metrics"][measure].at(frame).get<double>();
}

void print_row(const std::filesystem::path& folder) {
    const std::string name = folder.filename().string();
    if (!std::filesystem::exists(folder / "run.json")) {
        fmt::print("| {} | no result |\n", name);
        return;
    }
    const Json record = Json::parse(kinequad::read_text_file(folder / "run.json"));
    const Json& metrics = record["metrics"];
    const Json& alignment = metrics["stretch_alignment_degrees"];
    fmt::print(
        "| {} | {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {} | {:.0f} | {:.1f} | {} | "
        "{:.2f} | {:.1f} |\n",
        name, metrics["vertices"].get<int>(), metrics["singular_percent"].get<double>(),
        in_reference_frame(record, "angle_deviation_mean"),
        metrics["mean"]["angle_deviation_mean"].get<double>(),
        in_reference_frame(record, "hausdorff_percent"),
        metrics["mean"]["hausdorff_percent"].get<double>(),
        alignment.is_null() ? "-" : fmt::format("{:.1f}", alignment.get<double>()),
        in_reference_frame(record, "folded_quads"), metrics["mean"]["folded_quads"].get<double>(),
        record["map"]["flipped_triangles"].get<int>(),
        record["total"]["cpu_seconds_without_metrics"].get<double>(),
        record["total"]["cpu_seconds"].get<double>());
}

}  // namespace

int main(int argc, char** argv) {
    try {
        fmt::print(
            "| run | vertices | irregular % | angle deg, reference | angle deg, all frames | "
            "Hausdorff %, "
            "reference | Hausdorff %, all frames | alignment deg | folded, reference | folded, all "
            "frames "
            "| flipped triangles | CPU s | CPU s with metrics |\n"
            "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
        for (int i = 1; i < argc; ++i) print_row(argv[i]);
    } catch (const std::exception& error) {
        fmt::print(stderr, "kinequad_table: error: {}\n", error.what());
        return 1;
    }
    return 0;
}
