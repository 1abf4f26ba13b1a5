#include "kinequad/extract/part_parallel_edges.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "kinequad/core/index.h"

namespace kinequad::extraction {
namespace {

/// Corners of the hexagon of two quads, counter-clockwise from the end of the edge between them.
using Hexagon = std::array<int, 6>;

class Parting {
public:
    explicit Parting(const Cells& doubled)
        : doubled_(doubled),
          cells_(gather_quads(doubled)),
          is_used_(cells_.size(), 0),
          valence_(doubled.mesh.vertex.size(), 0) {
        for (std::size_t c = 0; c < cells_.size(); ++c) {
            for (std::size_t k = 0; k < 4; ++k) {
                Edge& edge = edges_[cells_[c].middle[k]];
                edge.sides.emplace_back(c, k);
                edge.ends = std::minmax({cells_[c].corner[k], cells_[c].corner[(k + 1) % 4]});
            }
        }
        for (const auto& [name, edge] : edges_) {
            ++valence_[at(edge.ends.first)];
            ++valence_[at(edge.ends.second)];
        }
    }

    std::optional<PartedQuads> run() {
        std::map<std::pair<int, int>, std::vector<int>> between;
        for (const auto& [name, edge] : edges_) {
            if (edge.ends.first == edge.ends.second) return std::nullopt;
            between[edge.ends].push_back(name);
        }
        PartedQuads result;
        for (const auto& [ends, names] : between) {
            std::size_t left = names.size();
            for (const int name : names) {
                if (left > 1 && part(name)) --left;
            }
            if (left > 1) return std::nullopt;
            result.parted_edges += static_cast<int>(names.size() - left);
        }
        for (std::size_t c = 0; c < cells_.size(); ++c) {
            if (is_used_[c] == 0) quads_.push_back(cells_[c].corner);
        }
        result.mesh = mesh_of(quads_, doubled_.mesh.vertex);
        return result;
    }

private:
    /// An edge of the wanted quads.
    struct Edge {
        std::vector<std::pair<std::size_t, std::size_t>> sides;  ///< cells, and which edge of them
        std::pair<int, int> ends;
    };

    /// Takes an edge away, if it is free to go.
    bool part(int name) {
        const Edge& edge = edges_[name];
        if (edge.sides.size() != 2 || doubled_.is_on_line[at(name)] != 0) return false;
        const auto [first, k] = edge.sides[0];
        const auto [second, j] = edge.sides[1];
        if (is_used_[first] != 0 || is_used_[second] != 0) return false;
        const auto& a = cells_[first].corner;
        const auto& b = cells_[second].corner;
        const Hexagon hexagon = {a[(k + 1) % 4], a[(k + 2) % 4], a[(k + 3) % 4],
                                 a[k],           b[(j + 2) % 4], b[(j + 3) % 4]};
        Hexagon sorted = hexagon;
        std::sort(sorted.begin(), sorted.end());
        if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) return false;
        // The new vertex is joined to every other corner; one end of the edge loses a neighbour.
        const std::size_t start = excess_joining(hexagon, 0) < excess_joining(hexagon, 1) ? 0 : 1;
        const int loser = hexagon[start == 0 ? 3 : 0];
        if (valence_[at(loser)] < least_valence(loser)) return false;
        for (std::size_t i = start; i < 6; i += 2) {
            ++valence_[at(hexagon[i])];
            quads_.push_back({name, hexagon[i], hexagon[(i + 1) % 6], hexagon[(i + 2) % 6]});
        }
        --valence_[at(hexagon[0])];
        --valence_[at(hexagon[3])];
        is_used_[first] = is_used_[second] = 1;
        return true;
    }

    /// Valence with which a vertex can lose an edge.
    int least_valence(int v) const { return doubled_.is_on_line[at(v)] != 0 ? 5 : 4; }

    /// How far valences are from four where every other corner from `start` on gets an edge.
    int excess_joining(const Hexagon& hexagon, std::size_t start) const {
        int sum = 0;
        for (std::size_t i = 0; i < 6; ++i) {
            const int change = (i % 2 == start ? 1 : 0) - (i % 3 == 0 ? 1 : 0);
            const int away = valence_[at(hexagon[i])] + change - 4;
            sum += away * away;
        }
        return sum;
    }

    const Cells& doubled_;
    std::vector<WantedQuad> cells_;
    std::vector<char> is_used_;
    std::vector<int> valence_;
    std::map<int, Edge> edges_;  ///< by their middles
    std::vector<std::array<int, 4>> quads_;
};

}  // namespace

std::optional<PartedQuads> part_parallel_edges(const Cells& doubled) {
    return Parting(doubled).run();
}

}  // namespace kinequad::extraction
