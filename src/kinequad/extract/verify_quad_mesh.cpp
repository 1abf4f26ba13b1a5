#include "kinequad/extract/verify_quad_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "kinequad/core/disjoint_sets.h"
#include "kinequad/core/error.h"
#include "kinequad/core/index.h"

namespace kinequad {
namespace {

bool is_valid_quad(const Quads& Q, int q, int vertex_count) {
    for (int k = 0; k < 4; ++k) {
        if (Q(q, k) < 0 || Q(q, k) >= vertex_count) return false;
        for (int j = 0; j < k; ++j) {
            if (Q(q, j) == Q(q, k)) return false;
        }
    }
    return true;
}

int count_invalid_points(const QuadMesh& mesh, int triangle_count) {
    int count = 0;
    for (const SurfacePoint& point : mesh.vertex) {
        const Vector3& b = point.barycentric;
        const bool is_valid = point.triangle >= 0 && point.triangle < triangle_count &&
                              b.allFinite() && b.minCoeff() >= 0 && std::abs(b.sum() - 1) < 1e-9;
        count += is_valid ? 0 : 1;
    }
    return count;
}

/// Side `side` = 4q + k of a quad, from its corner k to the next, on an undirected edge.
struct Side {
    std::uint64_t edge;
    int side;
};

int next_corner(int corner) { return corner % 4 == 3 ? corner - 3 : corner + 1; }

/// The sides of all valid quads, those on the same pair of vertices next to each other. Edges are
/// pairs of vertices, since that is all that a mesh file keeps of them.
std::vector<Side> sorted_sides(const Quads& Q, const std::vector<bool>& is_valid) {
    std::vector<Side> sides;
    for (int side = 0; side < Q.size(); ++side) {
        if (!is_valid[at(side / 4)]) continue;
        const auto a = static_cast<std::uint64_t>(Q.data()[side]);
        const auto b = static_cast<std::uint64_t>(Q.data()[next_corner(side)]);
        sides.push_back({std::min(a, b) << 32U | std::max(a, b), side});
    }
    std::sort(sides.begin(), sides.end(), [](const Side& x, const Side& y) {
        return x.edge != y.edge ? x.edge < y.edge : x.side < y.side;
    });
    return sides;
}

}  // namespace

bool QuadMeshReport::valid() const {
    return invalid_quads == 0 && non_manifold_edges == 0 && misoriented_edges == 0 &&
           non_manifold_vertices == 0 && isolated_vertices == 0 && invalid_points == 0 &&
           components == input.components && boundary_loops == input.boundary_loops &&
           euler_characteristic == input.euler_characteristic;
}

QuadMeshReport verify_quad_mesh(const QuadMesh& mesh, const Topology& input_topology) {
    const Quads& Q = mesh.Q;
    const int vertex_count = static_cast<int>(mesh.vertex.size());
    const int quad_count = static_cast<int>(Q.rows());
    const auto vertex_at = [&](int corner) { return Q.data()[corner]; };
    QuadMeshReport report;
    report.input = count_surface(input_topology);
    report.invalid_points = count_invalid_points(mesh, input_topology.triangle_count);

    std::vector<bool> is_valid(at(quad_count));
    for (int q = 0; q < quad_count; ++q) {
        is_valid[at(q)] = is_valid_quad(Q, q, vertex_count);
        ++(is_valid[at(q)] ? report.quads : report.invalid_quads);
    }

    // Corners of one vertex are in one set where a fan of quads joins them; vertices of one
    // boundary loop are in one set.
    DisjointSets quads(at(quad_count));
    DisjointSets corners(at(4 * quad_count));
    DisjointSets loops(at(vertex_count));
    std::vector<bool> is_on_boundary(at(vertex_count), false);
    const std::vector<Side> sides = sorted_sides(Q, is_valid);
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t j = i + 1;
        for (; j < sides.size() && sides[j].edge == sides[i].edge; ++j) {
            const int a = sides[i].side;
            const int b = sides[j].side;
            const bool is_same_way = vertex_at(a) == vertex_at(b);
            quads.unite(a / 4, b / 4);
            corners.unite(a, is_same_way ? b : next_corner(b));
            corners.unite(next_corner(a), is_same_way ? next_corner(b) : b);
            report.misoriented_edges += j == i + 1 && is_same_way ? 1 : 0;
        }
        if (j - i == 1) {
            const int a = vertex_at(sides[i].side);
            const int b = vertex_at(next_corner(sides[i].side));
            loops.unite(a, b);
            is_on_boundary[at(a)] = is_on_boundary[at(b)] = true;
        }
        report.non_manifold_edges += j - i > 2 ? 1 : 0;
        ++report.edges;
        i = j;
    }

    std::vector<int> fans(at(vertex_count), 0);
    for (int corner = 0; corner < 4 * quad_count; ++corner) {
        if (!is_valid[at(corner / 4)]) continue;
        fans[at(vertex_at(corner))] += corners.find(corner) == corner ? 1 : 0;
        report.components += corner % 4 == 0 && quads.find(corner / 4) == corner / 4 ? 1 : 0;
    }
    for (int v = 0; v < vertex_count; ++v) {
        report.vertices += fans[at(v)] > 0 ? 1 : 0;
        report.isolated_vertices += fans[at(v)] == 0 ? 1 : 0;
        report.non_manifold_vertices += fans[at(v)] > 1 ? 1 : 0;
        report.boundary_loops += is_on_boundary[at(v)] && loops.find(v) == v ? 1 : 0;
    }
    report.euler_characteristic = report.vertices - report.edges + report.quads;
    return report;
}

void require_valid(const QuadMeshReport& report) {
    if (report.valid()) return;
    std::string faults;
    const auto add = [&](int count, int expected, const char* what) {
        if (count == expected) return;
        faults += faults.empty() ? "" : ", ";
        faults += expected == 0 ? fmt::format("{} {}", count, what)
                                : fmt::format("{} {} instead of {}", count, what, expected);
    };
    add(report.invalid_quads, 0, "invalid quads");
    add(report.non_manifold_edges, 0, "non-manifold edges");
    add(report.misoriented_edges, 0, "misoriented edges");
    add(report.non_manifold_vertices, 0, "non-manifold vertices");
    add(report.isolated_vertices, 0, "isolated vertices");
    add(report.invalid_points, 0, "vertices off the surface");
    add(report.components, report.input.components, "components");
    add(report.boundary_loops, report.input.boundary_loops, "boundary loops");
    if (report.euler_characteristic != report.input.euler_characteristic) {
        faults += fmt::format("{}Euler characteristic {} instead of {}", faults.empty() ? "" : ", ",
                              report.euler_characteristic, report.input.euler_characteristic);
    }
    throw VerificationError("the quad mesh failed its checks: " + faults +
                            "; ask for more quads, or report the input");
}

}  // namespace kinequad
