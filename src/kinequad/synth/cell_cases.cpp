#include "kinequad/synth/cell_cases.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "kinequad/core/index.h"

namespace kinequad::synth_detail {
namespace {

int edge_number(int axis, int u, int v) { return 4 * axis + u + 2 * v; }

/// A side of a cell: its four corners around, and the edges from each to the next.
struct Side {
    std::array<int, 4> corner;
    std::array<int, 4> edge;
};

Side make_side(int axis, int place) {
    const int b = (axis + 1) % 3;
    const int c = (axis + 2) % 3;
    const auto corner = [&](int at_b, int at_c) { return place << axis | at_b << b | at_c << c; };
    // Along b the axes that follow are c and `axis`; along c they are `axis` and b.
    return {{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)},
            {edge_number(b, 0, place), edge_number(c, place, 1), edge_number(b, 1, place),
             edge_number(c, place, 0)}};
}

CellCase make_case(unsigned mask) {
    const auto inside = [&](int corner) { return (mask >> corner & 1U) != 0; };
    std::array<int, 12> root{};
    std::iota(root.begin(), root.end(), 0);
    const auto find = [&](int edge) {
        while (root[at(edge)] != edge) {
            edge = root[at(edge)];
        }
        return edge;
    };
    const auto join = [&](int a, int b) {
        const int first = find(a);
        const int second = find(b);
        root[at(std::max(first, second))] = std::min(first, second);
    };
    for (int axis = 0; axis < 3; ++axis) {
        for (int place = 0; place < 2; ++place) {
            const Side side = make_side(axis, place);
            std::vector<int> crossed;
            for (std::size_t k = 0; k < 4; ++k) {
                if (inside(side.corner[k]) != inside(side.corner[(k + 1) % 4])) {
                    crossed.push_back(side.edge[k]);
                }
            }
            if (crossed.size() == 2) join(crossed[0], crossed[1]);
            if (crossed.size() == 4) {
                for (std::size_t k = 0; k < 4; ++k) {
                    if (inside(side.corner[k])) join(side.edge[k], side.edge[(k + 3) % 4]);
                }
            }
        }
    }
    CellCase made;
    made.piece.fill(-1);
    std::array<int, 12> number{};
    number.fill(-1);
    for (int edge = 0; edge < 12; ++edge) {
        const auto [a, b] = cell_edge_corners(edge);
        if (inside(a) == inside(b)) continue;
        int& piece = number[at(find(edge))];
        if (piece < 0) piece = made.piece_count++;
        made.piece[at(edge)] = piece;
    }
    return made;
}

}  // namespace

const CellCase& cell_case(unsigned mask) {
    static const std::array<CellCase, 256> cases = [] {
        std::array<CellCase, 256> made;
        for (unsigned i = 0; i < 256; ++i) made[i] = make_case(i);
        return made;
    }();
    return cases[mask];
}

std::array<int, 2> cell_edge_corners(int edge) {
    const int axis = edge / 4;
    const int from = (edge & 1) << (axis + 1) % 3 | (edge >> 1 & 1) << (axis + 2) % 3;
    return {from, from | 1 << axis};
}

}  // namespace kinequad::synth_detail
