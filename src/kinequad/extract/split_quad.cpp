#include "kinequad/extract/split_quad.h"

namespace kinequad::extraction {

std::vector<std::array<int, 4>> split_quad(const std::array<int, 4>& v, const std::array<int, 4>& m,
                                           int centre, SplitEdges edges) {
    if (edges.even && edges.odd) {
        return {{v[0], m[0], centre, m[3]},
                {v[1], m[1], centre, m[0]},
                {v[2], m[2], centre, m[1]},
                {v[3], m[3], centre, m[2]}};
    }
    if (edges.even) return {{v[0], m[0], m[2], v[3]}, {m[0], v[1], v[2], m[2]}};
    if (edges.odd) return {{v[0], v[1], m[1], m[3]}, {m[3], m[1], v[2], v[3]}};
    return {v};
}

}  // namespace kinequad::extraction
