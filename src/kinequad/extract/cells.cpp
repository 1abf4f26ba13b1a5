#include "kinequad/extract/cells.h"

#include <algorithm>
#include <map>
#include <utility>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/core/sort_unique.h"

namespace kinequad::extraction {
namespace {

[[noreturn]] void throw_bordering_on_itself() {
    throw VerificationError("a quad borders on itself; ask for more quads");
}

}  // namespace

bool has_parallel_edges(const Cells& cells) {
    const Quads& Q = cells.mesh.Q;
    std::vector<std::pair<int, int>> edges;
    edges.reserve(static_cast<std::size_t>(Q.size()));
    for (Eigen::Index q = 0; q < Q.rows(); ++q) {
        for (int k = 0; k < 4; ++k) {
            edges.push_back(std::minmax({Q(q, k), Q(q, (k + 1) % 4)}));
            if (edges.back().first == edges.back().second) return true;
        }
    }
    sort_unique(edges);
    return edges.size() < cells.edge_count;
}

std::vector<WantedQuad> gather_quads(const Cells& doubled) {
    struct Quarter {
        int corner = -1;
        int after = -1;   ///< middle of the edge that leaves the corner
        int before = -1;  ///< middle of the edge that arrives there
    };
    std::map<int, std::vector<Quarter>> around;
    const Quads& Q = doubled.mesh.Q;
    for (Eigen::Index q = 0; q < Q.rows(); ++q) {
        for (int k = 0; k < 4; ++k) {
            if (doubled.odd_coordinates[at(Q(q, k))] != 0) continue;
            around[Q(q, (k + 2) % 4)].push_back({Q(q, k), Q(q, (k + 1) % 4), Q(q, (k + 3) % 4)});
        }
    }
    std::vector<WantedQuad> cells;
    for (const auto& [centre, quarters] : around) {
        if (quarters.size() != 4) throw_bordering_on_itself();
        WantedQuad cell{{}, {}, centre};
        std::size_t i = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            cell.corner[k] = quarters[i].corner;
            cell.middle[k] = quarters[i].after;
            std::size_t next = 0;
            while (next < 4 && quarters[next].before != quarters[i].after) ++next;
            if (next == 4) throw_bordering_on_itself();
            i = next;
        }
        if (i != 0) throw_bordering_on_itself();
        cells.push_back(cell);
    }
    if (4 * cells.size() != static_cast<std::size_t>(Q.rows())) throw_bordering_on_itself();
    return cells;
}

QuadMesh mesh_of(const std::vector<std::array<int, 4>>& quads,
                 const std::vector<SurfacePoint>& points) {
    QuadMesh mesh;
    std::vector<int> number(points.size(), -1);
    for (const auto& quad : quads) {
        for (const int vertex : quad) number[at(vertex)] = 0;
    }
    for (std::size_t v = 0; v < number.size(); ++v) {
        if (number[v] < 0) continue;
        number[v] = static_cast<int>(mesh.vertex.size());
        mesh.vertex.push_back(points[v]);
    }
    mesh.Q.resize(static_cast<Eigen::Index>(quads.size()), 4);
    for (std::size_t q = 0; q < quads.size(); ++q) {
        for (std::size_t k = 0; k < 4; ++k) {
            mesh.Q(static_cast<Eigen::Index>(q), static_cast<Eigen::Index>(k)) =
                number[at(quads[q][k])];
        }
    }
    return mesh;
}

}  // namespace kinequad::extraction
