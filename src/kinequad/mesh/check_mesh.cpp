#include "kinequad/mesh/check_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>

#include "kinequad/core/index.h"
#include "kinequad/mesh/edge_fans.h"
#include "kinequad/mesh/find_crossings.h"
#include "kinequad/mesh/flat_triangles.h"

namespace kinequad {
namespace {

std::vector<std::array<int, 2>> find_coincident_vertices(const Positions& V) {
    std::vector<int> order(static_cast<std::size_t>(V.rows()));
    std::iota(order.begin(), order.end(), 0);
    const auto key = [&](int v) { return std::array<double, 3>{V(v, 0), V(v, 1), V(v, 2)}; };
    std::sort(order.begin(), order.end(), [&](int a, int b) {
        const auto x = key(a);
        const auto y = key(b);
        return x != y ? x < y : a < b;
    });
    std::vector<std::array<int, 2>> pairs;
    for (std::size_t i = 1, first = 0; i < order.size(); ++i) {
        if (key(order[i]) == key(order[first])) {
            pairs.push_back({order[first], order[i]});
        } else {
            first = i;
        }
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

std::string count_of(std::size_t count, const char* one, const char* many) {
    return fmt::format("{} {}", count, count == 1 ? one : many);
}

std::string list_pairs(const std::vector<std::array<int, 2>>& pairs) {
    constexpr std::size_t most = 5;
    std::string text;
    for (std::size_t i = 0; i < std::min(pairs.size(), most); ++i) {
        text += fmt::format("{}{}-{}", i > 0 ? ", " : "", pairs[i][0], pairs[i][1]);
    }
    if (pairs.size() > most) text += fmt::format(" and {} more", pairs.size() - most);
    return text;
}

std::string list_edges(const std::vector<EdgeFinding>& edges) {
    constexpr std::size_t most = 3;
    std::string text;
    for (std::size_t i = 0; i < std::min(edges.size(), most); ++i) {
        text += fmt::format("{}{}-{} (triangles {})", i > 0 ? ", " : "", edges[i].a, edges[i].b,
                            list_elements(edges[i].triangles));
    }
    if (edges.size() > most) text += fmt::format(" and {} more", edges.size() - most);
    return text;
}

}  // namespace

bool MeshReport::is_accepted() const {
    return triangles > 0 && wild_triangles.empty() && collapsed_triangles.empty() &&
           duplicate_triangles.empty() && non_manifold_edges.empty() && misoriented_edges.empty() &&
           non_manifold_vertices.empty();
}

MeshReport check_mesh(const Triangles& F, const Positions& V, const MeshCheckOptions& options,
                      const Context& context) {
    MeshReport report;
    report.vertices = static_cast<int>(V.rows());
    report.triangles = static_cast<int>(F.rows());
    // What cannot be looked up in space, or would be in the way of fans and edges, is left out of
    // them.
    std::vector<int> sound;
    std::vector<char> is_used(at(report.vertices), 0);
    for (int t = 0; t < report.triangles; ++t) {
        const auto row = F.row(t);
        if (row.minCoeff() < 0 || row.maxCoeff() >= report.vertices) {
            report.wild_triangles.push_back(t);
            continue;
        }
        for (int k = 0; k < 3; ++k) is_used[at(row[k])] = 1;
        if (row[0] == row[1] || row[1] == row[2] || row[2] == row[0]) {
            report.collapsed_triangles.push_back(t);
            continue;
        }
        if (is_flat_triangle(F, V, t)) report.flat_triangles.push_back(t);
        sound.push_back(t);
    }
    for (int v = 0; v < report.vertices; ++v) {
        if (is_used[at(v)] == 0) report.isolated_vertices.push_back(v);
    }
    report.duplicate_triangles = find_duplicate_triangles(F, sound);
    std::vector<int> distinct;
    std::vector<char> is_later(at(report.triangles), 0);
    for (const auto& pair : report.duplicate_triangles) is_later[at(pair[1])] = 1;
    std::copy_if(sound.begin(), sound.end(), std::back_inserter(distinct),
                 [&](int t) { return is_later[at(t)] == 0; });
    for (const EdgeFan& fan : find_edge_fans(F, distinct)) {
        const auto triangles_of = [&] {
            std::vector<int> triangles;
            for (const int h : fan.half_edges) triangles.push_back(h / 3);
            return triangles;
        };
        if (fan.half_edges.size() > 2) {
            report.non_manifold_edges.push_back({fan.a, fan.b, triangles_of()});
        } else if (fan.half_edges.size() == 2 && fan.runs_one_way(F)) {
            report.misoriented_edges.push_back({fan.a, fan.b, triangles_of()});
        }
    }
    const FanCorners corners = group_corners(F, distinct);
    report.non_manifold_vertices = corners.vertices_with_several_fans(F, report.vertices);
    report.unorientable_parts = orient_parts(F, distinct).unorientable;
    report.coincident_vertices = find_coincident_vertices(V);
    if (options.most_crossings > 0 && report.wild_triangles.empty()) {
        report.crossing_triangles = find_crossing_triangles(F, V, options.most_crossings, context);
        report.has_more_crossings =
            static_cast<int>(report.crossing_triangles.size()) >= options.most_crossings;
    }
    if (report.is_accepted()) {
        report.counts = count_surface(build_topology(F, report.vertices));
        report.genus = (2 * report.counts.components - report.counts.boundary_loops -
                        report.counts.euler_characteristic) /
                       2;
    }
    return report;
}

std::string list_elements(const std::vector<int>& elements) {
    constexpr std::size_t most = 5;
    std::string text;
    for (std::size_t i = 0; i < std::min(elements.size(), most); ++i) {
        text += fmt::format("{}{}", i > 0 ? ", " : "", elements[i]);
    }
    if (elements.size() > most) text += fmt::format(" and {} more", elements.size() - most);
    return text;
}

std::vector<std::string> describe_refusals(const MeshReport& report) {
    std::vector<std::string> lines;
    const auto add = [&](std::size_t count, const char* one, const char* many,
                         const std::string& elements, const char* remedy) {
        if (count == 0) return;
        lines.push_back(fmt::format("{}: {}; {}", count_of(count, one, many), elements, remedy));
    };
    if (report.triangles == 0) lines.emplace_back("no faces; nothing to do");
    add(report.wild_triangles.size(), "triangle names a vertex that does not exist",
        "triangles name vertices that do not exist", list_elements(report.wild_triangles),
        "mend the face list");
    add(report.collapsed_triangles.size(), "triangle names a vertex twice",
        "triangles name a vertex twice", list_elements(report.collapsed_triangles),
        "remove them, or run with --repair");
    add(report.duplicate_triangles.size(), "triangle repeats the vertices of another",
        "triangles repeat the vertices of others", list_pairs(report.duplicate_triangles),
        "remove one of each, or run with --repair");
    add(report.non_manifold_edges.size(), "non-manifold edge", "non-manifold edges",
        list_edges(report.non_manifold_edges), "split the surface there");
    if (!report.unorientable_parts.empty()) {
        add(report.unorientable_parts.size(), "part cannot be oriented (it has one side only)",
            "parts cannot be oriented (they have one side only)",
            "with triangles " + list_elements(report.unorientable_parts) + ", edges " +
                list_edges(report.misoriented_edges),
            "cut the surface open");
    } else {
        add(report.misoriented_edges.size(), "edge between triangles oriented against each other",
            "edges between triangles oriented against each other",
            list_edges(report.misoriented_edges),
            "orient the faces consistently, or run with --repair");
    }
    add(report.non_manifold_vertices.size(), "non-manifold vertex", "non-manifold vertices",
        list_elements(report.non_manifold_vertices),
        "duplicate them, one copy a fan, or run with --repair");
    return lines;
}

std::vector<std::string> describe_remarks(const MeshReport& report) {
    std::vector<std::string> lines;
    const auto add = [&](std::size_t count, const char* one, const char* many,
                         const std::string& elements) {
        if (count == 0) return;
        lines.push_back(fmt::format("{}: {}", count_of(count, one, many), elements));
    };
    add(report.isolated_vertices.size(), "vertex without triangles", "vertices without triangles",
        list_elements(report.isolated_vertices));
    add(report.flat_triangles.size(), "triangle without area", "triangles without area",
        list_elements(report.flat_triangles));
    add(report.coincident_vertices.size(), "vertex at the place of another",
        "vertices at the place of others", list_pairs(report.coincident_vertices));
    add(report.crossing_triangles.size(), "pair of triangles passes through one another",
        report.has_more_crossings ? "pairs of triangles, or more, pass through one another"
                                  : "pairs of triangles pass through one another",
        list_pairs(report.crossing_triangles));
    return lines;
}

}  // namespace kinequad
