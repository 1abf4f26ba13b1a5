#include <algorithm>
#include <utility>
#include <vector>

#include "kinequad/core/index.h"
#include "kinequad/report/render_mesh.h"

namespace kinequad {

std::vector<RenderMarker> mark_irregular_vertices(const Quads& Q, int vertex_count) {
    const auto n = static_cast<std::size_t>(vertex_count);
    std::vector<int> quads_around(n, 0);
    std::vector<std::pair<int, int>> sides;
    sides.reserve(4 * static_cast<std::size_t>(Q.rows()));
    for (Eigen::Index q = 0; q < Q.rows(); ++q) {
        for (int k = 0; k < 4; ++k) {
            const int from = Q(q, k);
            const int to = Q(q, (k + 1) % 4);
            ++quads_around[at(from)];
            sides.emplace_back(std::min(from, to), std::max(from, to));
        }
    }
    std::sort(sides.begin(), sides.end());
    std::vector<bool> on_boundary(n, false);
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t end = i;
        while (end < sides.size() && sides[end] == sides[i]) ++end;
        if (end == i + 1) {
            on_boundary[at(sides[i].first)] = true;
            on_boundary[at(sides[i].second)] = true;
        }
        i = end;
    }
    std::vector<RenderMarker> markers;
    for (std::size_t v = 0; v < n; ++v) {
        const int around = quads_around[v];
        const bool regular =
            around == 0 || (on_boundary[v] ? around == 1 || around == 2 : around == 4);
        if (regular) continue;
        const bool low = !on_boundary[v] && around < 4;
        markers.push_back(
            {static_cast<int>(v), low ? Color(0.86, 0.10, 0.10) : Color(0.08, 0.28, 0.86)});
    }
    return markers;
}

}  // namespace kinequad
