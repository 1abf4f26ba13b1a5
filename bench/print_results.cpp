// Prints the tables of docs/results.md: `kinequad_results DIR...`, each a folder that
// `kinequad compare` has left, named after its sequence.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "kinequad/io/files.h"

namespace {

using Json = nlohmann::json;

struct Sequence {
    std::string name;
    Json methods;
    std::size_t frames = 0;

    const Json* find(const std::string& method) const {
        for (const Json& candidate : methods) {
            if (candidate["name"] == method) return &candidate;
        }
        return nullptr;
    }
};

Sequence read_sequence(const std::filesystem::path& folder) {
    const Json record = Json::parse(kinequad::read_text_file(folder / "compare.json"));
    return {folder.filename().string(), record["methods"], record["frames"].size()};
}

std::vector<double> values_of(const Json& method, const char* measure) {
    return method[measure].get<std::vector<double>>();
}

double mean_of(const Json& method, const char* measure) {
    double sum = 0;
    const std::vector<double> values = values_of(method, measure);
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

double largest_of(const Json& method, const char* measure) {
    const std::vector<double> values = values_of(method, measure);
    return *std::max_element(values.begin(), values.end());
}

double smallest_of(const Json& method, const char* measure) {
    const std::vector<double> values = values_of(method, measure);
    return *std::min_element(values.begin(), values.end());
}

std::string number(const Json& value, int decimals) {
    return value.is_number() ? fmt::format("{:.{}f}", value.get<double>(), decimals) : "-";
}

/// Share of the frames in which `measure` of `method` is below that of `other`, or not above it.
double percent_below(const Json& method, const Json& other, const char* measure, bool or_equal) {
    const std::vector<double> a = values_of(method, measure);
    const std::vector<double> b = values_of(other, measure);
    int count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        count += (or_equal ? a[i] <= b[i] : a[i] < b[i]) ? 1 : 0;
    }
    return 100.0 * count / static_cast<double>(a.size());
}

/// What the comparison has to show: the defaults against the others.
void print_claims(const std::vector<Sequence>& sequences) {
    fmt::print(
        "| sequence | frames | singular vertices: kinequad / single pose / animation only / paper "
        "| "
        "frames with smaller angle than animation only | frames with Hausdorff distance not above "
        "|\n|---|---|---|---|---|\n");
    for (const Sequence& sequence : sequences) {
        const Json* ours = sequence.find("kinequad");
        const Json* baseline = sequence.find("animation only");
        if (ours == nullptr || baseline == nullptr) continue;
        const auto singular = [&](const char* name) {
            const Json* method = sequence.find(name);
            return method == nullptr ? std::string("-")
                                     : fmt::format("{}", (*method)["singular_vertices"].get<int>());
        };
        fmt::print("| {} | {} | **{}** / {} / {} / {} | {:.1f} % | {:.1f} % |\n", sequence.name,
                   sequence.frames, singular("kinequad"), singular("single pose"),
                   singular("animation only"), singular("paper"),
                   percent_below(*ours, *baseline, "angle_deviation_mean", false),
                   percent_below(*ours, *baseline, "hausdorff_percent", true));
    }
}

void print_sequence(const Sequence& sequence) {
    fmt::print(
        "\n### {}\n\n"
        "| method | vertices | singular | proportion | angle °, mean | worst frame | Hausdorff %, "
        "mean | worst frame | mean distance % | scaled Jacobian, smallest: mean | worst frame | "
        "symmetry error ° | stretch alignment ° | CPU s |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
        sequence.name);
    for (const Json& method : sequence.methods) {
        const int vertices = method["vertices"].get<int>();
        const int singular = method["singular_vertices"].get<int>();
        fmt::print(
            "| {} | {} | {} | {:.2f} % | {:.2f} | {:.2f} | {:.3f} | {:.3f} | {:.4f} | {:.2f} | "
            "{:.2f} | {} | {} | {} |\n",
            method["name"].get<std::string>(), vertices, singular, 100.0 * singular / vertices,
            mean_of(method, "angle_deviation_mean"), largest_of(method, "angle_deviation_mean"),
            mean_of(method, "hausdorff_percent"), largest_of(method, "hausdorff_percent"),
            mean_of(method, "mean_distance_percent"), mean_of(method, "scaled_jacobian_min"),
            smallest_of(method, "scaled_jacobian_min"), number(method["symmetry_error_degrees"], 2),
            number(method["stretch_alignment_degrees"], 1), number(method["cpu_seconds"], 1));
    }
}

}  // namespace

int main(int argc, char** argv) {
    try {
        std::vector<Sequence> sequences;
        for (int i = 1; i < argc; ++i) sequences.push_back(read_sequence(argv[i]));
        print_claims(sequences);
        for (const Sequence& sequence : sequences) print_sequence(sequence);
    } catch (const std::exception& error) {
        fmt::print(stderr, "kinequad_results: error: {}\n", error.what());
        return 1;
    }
    return 0;
}
