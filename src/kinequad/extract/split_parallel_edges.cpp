#include "kinequad/extract/split_parallel_edges.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "kinequad/core/disjoint_sets.h"
#include "kinequad/core/index.h"
#include "kinequad/extract/split_quad.h"

namespace kinequad::extraction {
namespace {

class Splitting {
public:
    explicit Splitting(const Cells& doubled)
        : doubled_(doubled), cells_(gather_quads(doubled)), row_(doubled.mesh.vertex.size()) {
        for (const WantedQuad& cell : cells_) {
            for (const std::size_t k : {0U, 1U}) row_.unite(cell.middle[k], cell.middle[k + 2]);
        }
        size_.assign(doubled_.mesh.vertex.size(), 0);
        for (const WantedQuad& cell : cells_) {
            for (const int middle : cell.middle) ++size_[at(row_.find(middle))];
        }
        is_split_.assign(doubled_.mesh.vertex.size(), 0);
    }

    QuadMesh run() {
        while (split_one_more()) {
        }
        return assemble();
    }

private:
    /// An edge that stands for itself: whole, or inside a quad that is split.
    struct Edge {
        std::pair<int, int> ends;
        int name;  ///< its middle
        int row;   ///< that crosses it
        auto key() const { return std::pair(ends, name); }
    };

    /// Splits the shortest row that crosses one of several edges between the same two vertices.
    bool split_one_more() {
        std::vector<Edge> edges;
        for (const WantedQuad& cell : cells_) {
            for (std::size_t k = 0; k < 4; ++k) {
                const int row = row_.find(cell.middle[k]);
                if (is_split_[at(row)] != 0) continue;
                edges.push_back(
                    {std::minmax({cell.corner[k], cell.corner[(k + 1) % 4]}), cell.middle[k], row});
            }
            for (const std::size_t k : {0U, 1U}) {
                const int across = row_.find(cell.middle[k + 1]);
                if (is_split_[at(row_.find(cell.middle[k]))] == 0 || is_split_[at(across)] != 0)
                    continue;
                edges.push_back(
                    {std::minmax({cell.middle[k], cell.middle[k + 2]}), cell.centre, across});
            }
        }
        std::sort(edges.begin(), edges.end(),
                  [](const Edge& a, const Edge& b) { return a.key() < b.key(); });
        int chosen = -1;
        for (std::size_t i = 1; i < edges.size(); ++i) {
            const bool is_loop = edges[i].ends.first == edges[i].ends.second;
            const bool is_parallel =
                edges[i].ends == edges[i - 1].ends && edges[i].name != edges[i - 1].name;
            if (!is_loop && !is_parallel) continue;
            for (const int row : {edges[i - 1].row, edges[i].row}) {
                if (is_loop && row != edges[i].row) continue;
                const bool is_shorter = chosen < 0 || size_[at(row)] < size_[at(chosen)] ||
                                        (size_[at(row)] == size_[at(chosen)] && row < chosen);
                if (is_shorter) chosen = row;
            }
        }
        if (chosen < 0) return false;
        is_split_[at(chosen)] = 1;
        return true;
    }

    QuadMesh assemble() {
        std::vector<std::array<int, 4>> quads;
        for (const WantedQuad& cell : cells_) {
            const SplitEdges edges = {is_split_[at(row_.find(cell.middle[0]))] != 0,
                                      is_split_[at(row_.find(cell.middle[1]))] != 0};
            const auto pieces = split_quad(cell.corner, cell.middle, cell.centre, edges);
            quads.insert(quads.end(), pieces.begin(), pieces.end());
        }
        return mesh_of(quads, doubled_.mesh.vertex);
    }

    const Cells& doubled_;
    std::vector<WantedQuad> cells_;
    DisjointSets row_;  ///< middles of edges: those that one row crosses
    std::vector<int> size_;
    std::vector<char> is_split_;
};

}  // namespace

QuadMesh split_parallel_edges(const Cells& doubled) { return Splitting(doubled).run(); }

}  // namespace kinequad::extraction
