#include "kinequad/extract/split_rows.h"

#include <array>
#include <utility>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/extract/quad_topology.h"
#include "kinequad/extract/split_quad.h"

namespace kinequad {
namespace {

/// More rows than this mean that each new one makes another necessary.
constexpr int most_rows = 100;

/// An edge inside that joins two vertices of the curve, -1 where there is none.
int edge_across(const QuadTopology& topology, const std::vector<char>& is_on_curve) {
    for (int e = 0; e < topology.edge_count; ++e) {
        const int h = topology.edge_half_edge[at(e)];
        if (topology.is_boundary_edge(e)) continue;
        if (is_on_curve[at(topology.origin[at(h)])] && is_on_curve[at(topology.target(h))]) {
            return e;
        }
    }
    return -1;
}

/// The edges of the row of quads that `edge` crosses (e).
std::vector<char> row_of(const QuadTopology& topology, int edge) {
    std::vector<char> is_in_row(at(topology.edge_count), 0);
    std::vector<int> stack = {edge};
    is_in_row[at(edge)] = 1;
    while (!stack.empty()) {
        const int h = topology.edge_half_edge[at(stack.back())];
        stack.pop_back();
        for (const int side : {h, topology.twin[at(h)]}) {
            if (side < 0) continue;
            const int opposite = topology.edge[at(QuadTopology::next(QuadTopology::next(side)))];
            if (is_in_row[at(opposite)]) continue;
            is_in_row[at(opposite)] = 1;
            stack.push_back(opposite);
        }
    }
    return is_in_row;
}

}  // namespace

QuadMesh split_rows_across_curve(
    QuadMesh quads, std::vector<char> is_on_curve,
    const std::function<SurfacePoint(const std::vector<SurfacePoint>& points, bool is_on_boundary)>&
        middle) {
    for (int row = 0; row <= most_rows; ++row) {
        const QuadTopology topology =
            build_quad_topology(quads.Q, static_cast<int>(quads.vertex.size()));
        const int edge = edge_across(topology, is_on_curve);
        if (edge < 0) return quads;
        const std::vector<char> is_in_row = row_of(topology, edge);
        std::vector<int> middle_of(at(topology.edge_count), -1);
        for (int e = 0; e < topology.edge_count; ++e) {
            if (!is_in_row[at(e)]) continue;
            const int h = topology.edge_half_edge[at(e)];
            const int a = topology.origin[at(h)];
            const int b = topology.target(h);
            const bool is_boundary = topology.is_boundary_edge(e);
            middle_of[at(e)] = static_cast<int>(quads.vertex.size());
            quads.vertex.push_back(middle({quads.vertex[at(a)], quads.vertex[at(b)]}, is_boundary));
            is_on_curve.push_back(is_boundary && is_on_curve[at(a)] && is_on_curve[at(b)] ? 1 : 0);
        }
        std::vector<std::array<int, 4>> split;
        for (int q = 0; q < topology.quad_count; ++q) {
            std::array<int, 4> v{};
            std::array<int, 4> m{};
            for (int k = 0; k < 4; ++k) {
                v[at(k)] = quads.Q(q, k);
                m[at(k)] = middle_of[at(topology.edge[at(4 * q + k)])];
            }
            int centre = -1;
            if (m[0] >= 0 && m[1] >= 0) {
                centre = static_cast<int>(quads.vertex.size());
                quads.vertex.push_back(middle({quads.vertex[at(v[0])], quads.vertex[at(v[1])],
                                               quads.vertex[at(v[2])], quads.vertex[at(v[3])]},
                                              false));
                is_on_curve.push_back(0);
            }
            const auto pieces = extraction::split_quad(v, m, centre, {m[0] >= 0, m[1] >= 0});
            split.insert(split.end(), pieces.begin(), pieces.end());
        }
        quads.Q.resize(static_cast<Eigen::Index>(split.size()), 4);
        for (std::size_t q = 0; q < split.size(); ++q) {
            for (std::size_t k = 0; k < 4; ++k) {
                quads.Q(static_cast<Eigen::Index>(q), static_cast<Eigen::Index>(k)) = split[q][k];
            }
        }
    }
    throw VerificationError(
        "the quads have no room beside the line of symmetry; ask for more vertices, or for "
        "another --symmetry");
}

}  // namespace kinequad
