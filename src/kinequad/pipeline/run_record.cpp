#include "kinequad/pipeline/run_record.h"

#include <fmt/format.h>

#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

#include "kinequad/field/singularities.h"
#include "kinequad/measure/format_metrics.h"
#include "kinequad/pipeline/version.h"

namespace kinequad {
namespace {

using Json = nlohmann::ordered_json;

std::string name_of(Symmetrisation symmetrisation) {
    return symmetrisation == Symmetrisation::orbits ? "orbits" : "term";
}

std::string name_of(SymmetryMode mode) {
    switch (mode) {
        case SymmetryMode::field:
            return "field";
        case SymmetryMode::exact:
            return "exact";
        default:
            return "none";
    }
}

Json counts_record(const SurfaceCounts& counts) {
    return {{"vertices", counts.vertices},
            {"edges", counts.edges},
            {"triangles", counts.triangles},
            {"components", counts.components},
            {"boundary_loops", counts.boundary_loops},
            {"euler_characteristic", counts.euler_characteristic}};
}

Json field_record(const Result& result) {
    std::map<int, int> vertices_of_index;
    std::map<int, int> corners_of_index;
    int singularities = 0;
    for (const Singularity& singularity :
         list_singularities(result.domain.topology, result.field)) {
        ++(singularity.boundary ? corners_of_index : vertices_of_index)[singularity.index];
        singularities += singularity.boundary ? 0 : 1;
    }
    const auto by_index = [](const std::map<int, int>& counts) {
        Json object = Json::object();
        for (const auto& [index, count] : counts) object[fmt::format("{:+}", index)] = count;
        return object;
    };
    return {{"energy", result.field.energy},
            {"singularities", singularities},
            {"singularities_by_index_in_quarters", by_index(vertices_of_index)},
            {"boundary_corners_by_index_in_quarters", by_index(corners_of_index)},
            {"index_sum_in_quarters", result.field.index.sum()}};
}

/// What is known of the symmetry; null where the run made no use of it.
Json symmetry_record(const Result& result) {
    if (!result.symmetry) return {};
    const SymmetryReport& report = result.symmetry->report;
    Json record = {{"method", result.symmetry->map.method},
                   {"involution_mean_percent", report.involution_mean_percent},
                   {"involution_max_percent", report.involution_max_percent},
                   {"stationary_loops", report.stationary_loops},
                   {"stationary_paths", report.stationary_paths}};
    if (result.field_symmetry) {
        record["field"] = {{"mean_degrees", result.field_symmetry->mean_degrees},
                           {"singularities", result.field_symmetry->singularities},
                           {"partnered", result.field_symmetry->partnered}};
    }
    if (result.mirror) {
        const MirrorReport& mirror = result.mirror->report;
        record["mirror"] = {{"vertices", mirror.vertices},
                            {"fixed_vertices", mirror.fixed_vertices},
                            {"valid", mirror.valid()},
                            {"mean_distance_percent", result.mirror->mean_distance_percent},
                            {"largest_distance_percent", result.mirror->largest_distance_percent}};
    }
    return record;
}

Json map_record(const Result& result) {
    const GridMapReport report = verify_grid_map(result.map);
    return {{"triangles", result.map.mesh.F.rows()},
            {"flipped_triangles", report.flipped_triangles},
            {"feature_edges_wanted", result.domain.feature_edges.size()},
            {"feature_edges_on_lines", result.map.feature_edges.size()},
            {"valid", report.valid()}};
}

Json stages_record(const std::vector<StageTime>& times) {
    Json stages = Json::array();
    for (const StageTime& time : times) {
        stages.push_back({{"stage", time.stage},
                          {"wall_seconds", time.wall_seconds},
                          {"cpu_seconds", time.cpu_seconds}});
    }
    return stages;
}

Json total_record(const std::vector<StageTime>& times) {
    double wall = 0;
    double cpu = 0;
    double cpu_of_extras = 0;
    for (const StageTime& time : times) {
        wall += time.wall_seconds;
        cpu += time.cpu_seconds;
        if (time.stage == "metrics" || time.stage == "report") cpu_of_extras += time.cpu_seconds;
    }
    return {{"wall_seconds", wall},
            {"cpu_seconds", cpu},
            {"cpu_seconds_without_metrics", cpu - cpu_of_extras}};
}

}  // namespace

nlohmann::ordered_json make_options_record(const Options& options) {
    const bool rest = options.reference == Options::rest_shape;
    return {
        {"symmetry", name_of(*options.symmetry)},
        {"vertices", options.vertices},
        {"edge_length", options.edge_length},
        {"field", options.field == CrossFieldMethod::paper ? "paper" : "convex"},
        {"symmetrisation", name_of(*options.symmetrisation)},
        {"alpha", *options.alpha},
        {"curvature", options.curvature},
        {"feature_angle", options.feature_angle},
        {"features", options.features},
        {"singularity_cost", *options.singularity_cost},
        {"metric", options.metric == MetricChoice::mean ? "mean" : "reference"},
        {"reference", rest ? Json("rest") : Json(options.reference)},
        {"relax_rounds", options.relax_rounds},
        {"metrics", options.metrics},
    };
}

nlohmann::ordered_json make_run_record(const Result& result, const FrameSource& source,
                                       const std::string& digest,
                                       const std::optional<SequenceMetrics>& metrics) {
    Json record;
    record["program"] = "kinequad";
    record["version"] = version;
    record["options"] = make_options_record(result.options);
    record["input"] = {
        {"name", source.name()}, {"digest", digest}, {"frames", source.frame_count()}};
    record["input"].update(counts_record(count_surface(result.topology)));
    record["edge_length"] = result.edge_length;
    record["symmetry"] = symmetry_record(result);
    record["field"] = field_record(result);
    record["map"] = map_record(result);
    record["quads"] = {{"vertices", result.quads.vertex.size()}, {"quads", result.quads.Q.rows()}};
    record["notes"] = result.notes;
    record["stages"] = stages_record(result.times);
    record["total"] = total_record(result.times);
    record["metrics"] = metrics ? Json(to_json(*metrics)) : Json();
    return record;
}

std::string format_binding(const QuadMesh& quads, const Triangles& triangles) {
    std::string text = "{\"triangle\": [";
    const auto out = std::back_inserter(text);
    const char* separator = "";
    for (const SurfacePoint& point : quads.vertex) {
        fmt::format_to(out, "{}{}", separator, point.triangle);
        separator = ", ";
    }
    text += "],\n\"barycentric\": [";
    separator = "";
    for (const SurfacePoint& point : quads.vertex) {
        const Vector3& b = point.barycentric;
        fmt::format_to(out, "{}[{}, {}, {}]", separator, b[0], b[1], b[2]);
        separator = ",\n";
    }
    text += "],\n\"triangles\": [";
    separator = "";
    for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
        fmt::format_to(out, "{}[{}, {}, {}]", separator, triangles(t, 0), triangles(t, 1),
                       triangles(t, 2));
        separator = ",\n";
    }
    text += "]}\n";
    return text;
}

std::string format_mirror(const QuadMesh& quads) {
    return fmt::format("{{\"mirror\": [{}]}}\n", fmt::join(quads.mirror, ", "));
}

}  // namespace kinequad
