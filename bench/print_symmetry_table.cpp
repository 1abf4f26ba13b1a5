// Prints the tables of scripts/symmetry: `kinequad_symmetry_table --data FOLDER SEQUENCE...`, of
// what it left in out/symmetry.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/field/symmetrise_field.h"
#include "kinequad/io/files.h"
#include "kinequad/io/landmarks.h"
#include "kinequad/io/open_sequence.h"
#include "kinequad/measure/quad_shape.h"
#include "kinequad/pipeline/find_symmetry.h"
#include "kinequad/pipeline/quadrangulate.h"
#include "kinequad/pipeline/solved_input.h"

namespace {

using Json = nlohmann::json;
using kinequad::FieldSymmetry;
using kinequad::FrameSource;
using kinequad::Positions;
using kinequad::Quads;
using kinequad::Triangles;
using kinequad::Vector3;

/// A run of a sequence: its folder, and how the table calls it.
struct Mode {
    const char* folder;
    const char* name;
};
constexpr std::array<Mode, 5> modes = {{{"none", "none"},
                                        {"term", "field, term"},
                                        {"orbits", "field, orbits"},
                                        {"field", "field"},
                                        {"exact", "exact"}}};

std::filesystem::path folder_of(const std::string& sequence) {
    return std::filesystem::path("out/symmetry") / sequence;
}

Json record_of(const std::string& sequence, const std::string& mode) {
    const auto path = folder_of(sequence) / mode / "run.json";
    return std::filesystem::exists(path) ? Json::parse(kinequad::read_text_file(path)) : Json();
}

bool is_without_symmetry(const Json& record) { return record["options"]["symmetry"] == "none"; }

/// CPU time of some stages, in seconds.
double seconds_of(const Json& record, const std::vector<std::string>& stages) {
    double sum = 0;
    for (const Json& stage : record["stages"]) {
        if (std::count(stages.begin(), stages.end(), stage["stage"].get<std::string>()) > 0) {
            sum += stage["cpu_seconds"].get<double>();
        }
    }
    return sum;
}

/// The place of a point [triangle, b0, b1, b2] of symmetry.json on the surface `V`, `F`.
Vector3 place_of(const Json& point, const Positions& V, const Triangles& F) {
    Vector3 place = Vector3::Zero();
    for (int k = 0; k < 3; ++k) {
        place +=
            point[kinequad::at(k + 1)].get<double>() * V.row(F(point[0].get<int>(), k)).transpose();
    }
    return place;
}

double mean_of(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

/// Whether the true map is known, as of the bodies whose rest shape mirrors in x = 0.
bool has_true_map(const std::string& sequence) { return sequence.rfind("makehuman", 0) == 0; }

/// Errors of the map against the true mirror vertices, mean and 99th percentile, in percent.
std::string errors_against_truth(const std::filesystem::path& data, const FrameSource& frames,
                                 const Json& map) {
    std::ifstream file(data / "sequences" / "makehuman_mirror.txt");
    std::vector<int> mirror;
    for (int v = 0; file >> v;) mirror.push_back(v);
    const Positions V = frames.read_rest_shape();
    const double percent = 100 / kinequad::bounding_box_diagonal(V);
    std::vector<double> errors;
    for (std::size_t v = 0; v < mirror.size(); ++v) {
        const Vector3 place = place_of(map["image"][v], V, frames.triangles());
        errors.push_back(percent * (place - V.row(mirror[v]).transpose()).norm());
    }
    std::sort(errors.begin(), errors.end());
    return fmt::format("{:.4f} / {:.3f}", mean_of(errors), errors[errors.size() * 99 / 100]);
}

/// How many polylines of the stationary curve are closed, of all.
std::string closed_lines(const FrameSource& frames, const Json& map) {
    const Positions V = frames.read_frame(0);
    const double tolerance = 1e-9 * kinequad::bounding_box_diagonal(V);
    int closed = 0;
    for (const Json& line : map["stationary"]) {
        const Vector3 first = place_of(line.front(), V, frames.triangles());
        const Vector3 last = place_of(line.back(), V, frames.triangles());
        closed += (last - first).norm() <= tolerance ? 1 : 0;
    }
    return fmt::format("{} of {}", closed, map["stationary"].size());
}

/// Distance of the points of the stationary curve from the true midline, where the rest shape has
/// x = 0, mean and largest, in percent.
std::string distance_from_midline(const FrameSource& frames, const Json& map) {
    const Positions V = frames.read_rest_shape();
    const double percent = 100 / kinequad::bounding_box_diagonal(V);
    std::vector<double> distances;
    for (const Json& line : map["stationary"]) {
        for (const Json& point : line) {
            distances.push_back(percent * std::abs(place_of(point, V, frames.triangles())[0]));
        }
    }
    if (distances.empty()) return "-";
    return fmt::format("{:.4f} / {:.4f}", mean_of(distances),
                       *std::max_element(distances.begin(), distances.end()));
}

/// CPU time of the stage that finds the map, where the symmetry `mode` is asked for. That of
/// `field` also inserts the curve into the triangles, that of `exact` evens out the half.
std::string symmetry_seconds(const std::string& sequence, const std::string& mode) {
    const Json record = record_of(sequence, mode);
    return record.is_null() ? "-" : fmt::format("{:.2f}", seconds_of(record, {"symmetry"}));
}

/// Mean angle deviation over all frames of the solved and of the mirrored half, in degrees, and the
/// largest distance of a vertex from the reflection of its mirror vertex in the plane x = 0, in
/// percent of the diagonal.
struct Halves {
    double solved = 0;
    double mirrored = 0;
    double reflection_percent = 0;
};

Halves measure_halves(const std::string& sequence) {
    const auto folder = folder_of(sequence) / "exact";
    const auto frames = kinequad::open_sequence((folder / "quads.obj").string());
    const Quads Q = kinequad::require_quads(frames->polygons(), "quads.obj");
    const Json file = Json::parse(kinequad::read_text_file(folder / "mirror.json"));
    const std::vector<int> mirror = file["mirror"].get<std::vector<int>>();
    const Quads first = Q.topRows(Q.rows() / 2);
    const Quads second = Q.bottomRows(Q.rows() / 2);
    Halves halves;
    for (int f = 0; f < frames->frame_count(); ++f) {
        const Positions X = frames->read_frame(f);
        halves.solved += kinequad::measure_shape(X, first).angle_deviation_mean;
        halves.mirrored += kinequad::measure_shape(X, second).angle_deviation_mean;
        const double percent = 100 / kinequad::bounding_box_diagonal(X);
        for (Eigen::Index v = 0; v < X.rows(); ++v) {
            Vector3 image = X.row(mirror[static_cast<std::size_t>(v)]).transpose();
            image[0] = -image[0];
            halves.reflection_percent = std::max(halves.reflection_percent,
                                                 percent * (X.row(v).transpose() - image).norm());
        }
    }
    halves.solved /= frames->frame_count();
    halves.mirrored /= frames->frame_count();
    return halves;
}

void print_map(const std::string& sequence, const std::filesystem::path& data) {
    const auto path = folder_of(sequence) / "symmetry.json";
    if (!std::filesystem::exists(path)) {
        fmt::print("| {} | no map |\n", sequence);
        return;
    }
    const Json map = Json::parse(kinequad::read_text_file(path));
    const auto frames =
        kinequad::open_sequence((data / "sequences" / (sequence + ".obj")).string());
    const bool has_truth = has_true_map(sequence);
    fmt::print("| {} | {} | {} | {:.3f} | {} | {} | {} | {} / {} |\n", sequence,
               frames->triangles().rows(),
               has_truth ? errors_against_truth(data, *frames, map) : "",
               map["quality"]["involution_mean_percent"].get<double>(),
               map["quality"]["reversed_triangles"].get<int>(), closed_lines(*frames, map),
               has_truth ? distance_from_midline(*frames, map) : "",
               symmetry_seconds(sequence, "field"), symmetry_seconds(sequence, "exact"));
}

/// How symmetric the field of a run without symmetry is, against the map on the same metric and
/// surface; empty where that surface has no map. The field is solved again: the run leaves none.
std::optional<FieldSymmetry> measure_free_field(const std::string& sequence,
                                                const std::filesystem::path& data) {
    const auto frames =
        kinequad::open_sequence((data / "sequences" / (sequence + ".obj")).string());
    const auto landmarks = kinequad::read_landmarks(data / "landmarks" / (sequence + ".json"));
    kinequad::Options options;
    options.symmetry = kinequad::SymmetryMode::none;
    options.vertices = record_of(sequence, "none").at("options").at("vertices").get<int>();
    options.relax_rounds = 0;
    const kinequad::Context context;
    const kinequad::Result result = kinequad::quadrangulate(*frames, landmarks, options, context);
    const kinequad::SolvedInput input(*frames, result.topology, result.reference, result.refined);
    const kinequad::IntrinsicMetric& metric = result.domain.metric;
    try {
        const auto found =
            kinequad::find_symmetry(input.frames(), metric, landmarks, input.reference(), context);
        return kinequad::measure_field_symmetry(input.topology(), metric, result.field, found.map,
                                                input.reference(), input.frames().triangles(),
                                                3 * result.edge_length);
    } catch (const kinequad::InputError&) {
        return std::nullopt;
    }
}

/// The columns of the field's symmetry: what the record says of it, or what is measured here.
std::string field_columns(const Json& record, const std::string& sequence,
                          const std::filesystem::path& data) {
    if (is_without_symmetry(record)) {
        const std::optional<FieldSymmetry> symmetry = measure_free_field(sequence, data);
        if (!symmetry) return "- | -";
        return fmt::format("{:.2f} | {} of {}", symmetry->mean_degrees, symmetry->partnered,
                           symmetry->singularities);
    }
    if (!record["symmetry"].contains("field")) return " | ";
    const Json& symmetry = record["symmetry"]["field"];
    return fmt::format("{:.2f} | {} of {}", symmetry["mean_degrees"].get<double>(),
                       symmetry["partnered"].get<int>(), symmetry["singularities"].get<int>());
}

/// In how many frames the Hausdorff distance is not above that of `plain`, without symmetry.
std::string frames_not_above(const Json& record, const Json& plain) {
    if (is_without_symmetry(record)) return "";
    if (plain.is_null()) return "-";
    const auto values = record["metrics"]["hausdorff_percent"].get<std::vector<double>>();
    const auto others = plain["metrics"]["hausdorff_percent"].get<std::vector<double>>();
    int count = 0;
    for (std::size_t f = 0; f < values.size(); ++f) count += values[f] <= others.at(f) ? 1 : 0;
    return fmt::format("{} of {}", count, values.size());
}

void print_quads(const std::string& sequence, const std::filesystem::path& data) {
    const Json plain = record_of(sequence, "none");
    for (const auto& [mode, name] : modes) {
        const Json record = record_of(sequence, mode);
        if (record.is_null()) {
            fmt::print("| {} | {} | no result |\n", sequence, name);
            continue;
        }
        const Json& metrics = record["metrics"];
        fmt::print("| {} | {} | {} | {} | {} | {:.2f} | {:.3f} | {} | {} | {:.1f} | {:.2f} |\n",
                   sequence, name, metrics["vertices"].get<int>(),
                   metrics["singular_vertices"].get<int>(), field_columns(record, sequence, data),
                   metrics["mean"]["angle_deviation_mean"].get<double>(),
                   metrics["mean"]["hausdorff_percent"].get<double>(),
                   frames_not_above(record, plain), metrics["folded_quads"].at(0).get<int>(),
                   metrics["mean"]["folded_quads"].get<double>(),
                   seconds_of(record, {"field", "map", "extraction"}));
    }
}

void print_mirror(const std::string& sequence) {
    const Json record = record_of(sequence, "exact");
    if (record.is_null()) {
        fmt::print("| {} | no result |\n", sequence);
        return;
    }
    const Json& mirror = record["symmetry"]["mirror"];
    const Halves halves = measure_halves(sequence);
    const auto [better, worse] = std::minmax(halves.solved, halves.mirrored);
    const Json plain = record_of(sequence, "none");
    const std::vector<std::string> stages = {"field", "map", "extraction"};
    fmt::print("| {} | {} | {} | {} | {:.2f} / {:.2f} | {:.3f} | {:.2f} / {:.2f} | {:.1e} | {} |\n",
               sequence, mirror["valid"].get<bool>() ? "yes" : "NO", mirror["vertices"].get<int>(),
               mirror["fixed_vertices"].get<int>(), halves.solved, halves.mirrored, worse / better,
               mirror["mean_distance_percent"].get<double>(),
               mirror["largest_distance_percent"].get<double>(), halves.reflection_percent,
               plain.is_null()
                   ? "-"
                   : fmt::format("{:.2f}", seconds_of(record, stages) / seconds_of(plain, stages)));
}

}  // namespace

int main(int argc, char** argv) {
    try {
        if (argc < 4 || std::string(argv[1]) != "--data") {
            fmt::print(stderr, "usage: kinequad_symmetry_table --data FOLDER SEQUENCE...\n");
            return 2;
        }
        const std::filesystem::path data = argv[2];
        const std::vector<std::string> sequences(argv + 3, argv + argc);
        fmt::print(
            "| map of | triangles | error against the true map %, mean / 99 % | S(S(p)) %, mean | "
            "reversed triangles | closed lines | line from the true midline %, mean / largest | "
            "CPU s, "
            "symmetry stage of field / exact |\n|---|---|---|---|---|---|---|---|\n");
        for (const std::string& sequence : sequences) print_map(sequence, data);
        fmt::print(
            "\n| quads of | symmetry | vertices | singular | field error deg | partnered | angle "
            "deg, all frames | Hausdorff %, all frames | not above none in | folded, reference | "
            "folded, all frames | CPU s, field + map + extraction |\n"
            "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
        for (const std::string& sequence : sequences) print_quads(sequence, data);
        fmt::print(
            "\n| mirror of | verified | vertices | on the line | angle deg, solved / mirrored half "
            "| ratio | distance from the map %, mean / largest | reflection in x = 0 % | CPU, to "
            "none |\n|---|---|---|---|---|---|---|---|---|\n");
        for (const std::string& sequence : sequences) print_mirror(sequence);
    } catch (const std::exception& error) {
        fmt::print(stderr, "kinequad_symmetry_table: error: {}\n", error.what());
        return 1;
    }
    return 0;
}
