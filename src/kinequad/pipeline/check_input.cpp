#include "kinequad/pipeline/check_input.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "kinequad/core/error.h"

namespace kinequad {
namespace {

using Json = nlohmann::ordered_json;

Json edges_record(const std::vector<EdgeFinding>& edges) {
    Json list = Json::array();
    for (const EdgeFinding& edge : edges) {
        list.push_back({{"edge", {edge.a, edge.b}}, {"triangles", edge.triangles}});
    }
    return list;
}

}  // namespace

void require_valid_input(const FrameSource& source, const Positions& V, const Context& context) {
    const MeshReport report = check_mesh(source.triangles(), V, {}, context);
    const std::vector<std::string> refusals = describe_refusals(report);
    if (refusals.empty()) {
        for (const std::string& line : describe_remarks(report)) {
            context.write_log(LogLevel::info, "check: " + line);
        }
        return;
    }
    std::string more;
    if (refusals.size() > 1) {
        more = fmt::format(" ({} more kinds of defects; --check lists them)", refusals.size() - 1);
    }
    throw InputError(InputFault::mesh,
                     fmt::format("{}: {}{}", source.name(), refusals.front(), more));
}

std::string format_mesh_report(const MeshReport& report, const std::string& name) {
    std::string text =
        fmt::format("{}: {} vertices, {} triangles\n", name, report.vertices, report.triangles);
    if (report.is_accepted()) {
        text += fmt::format("{} components, genus {}, {} boundary loops, Euler characteristic {}\n",
                            report.counts.components, report.genus, report.counts.boundary_loops,
                            report.counts.euler_characteristic);
    }
    for (const std::string& line : describe_refusals(report)) text += "refused: " + line + "\n";
    for (const std::string& line : describe_remarks(report)) text += "remark: " + line + "\n";
    text += report.is_accepted() ? "valid\n" : "not valid\n";
    return text;
}

Json make_mesh_record(const MeshReport& report, const std::string& name) {
    Json record = {{"name", name},
                   {"valid", report.is_accepted()},
                   {"vertices", report.vertices},
                   {"triangles", report.triangles}};
    if (report.is_accepted()) {
        record.update({{"edges", report.counts.edges},
                       {"components", report.counts.components},
                       {"genus", report.genus},
                       {"boundary_loops", report.counts.boundary_loops},
                       {"euler_characteristic", report.counts.euler_characteristic}});
    }
    record["refused"] = {{"wild_triangles", report.wild_triangles},
                         {"collapsed_triangles", report.collapsed_triangles},
                         {"duplicate_triangles", report.duplicate_triangles},
                         {"non_manifold_edges", edges_record(report.non_manifold_edges)},
                         {"misoriented_edges", edges_record(report.misoriented_edges)},
                         {"non_manifold_vertices", report.non_manifold_vertices},
                         {"unorientable_parts", report.unorientable_parts}};
    record["remarks"] = {{"isolated_vertices", report.isolated_vertices},
                         {"flat_triangles", report.flat_triangles},
                         {"coincident_vertices", report.coincident_vertices},
                         {"crossing_triangles", report.crossing_triangles},
                         {"has_more_crossings", report.has_more_crossings}};
    return record;
}

}  // namespace kinequad
