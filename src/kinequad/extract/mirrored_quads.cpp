#include "kinequad/extract/mirrored_quads.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "kinequad/core/index.h"

namespace kinequad {
namespace {

/// The corners of a quad from its lowest on: equal for equal oriented quads.
std::array<int, 4> from_lowest(std::array<int, 4> corners) {
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    return corners;
}

bool names_vertices(const QuadMesh& quads) {
    const int count = static_cast<int>(quads.vertex.size());
    return quads.mirror.size() == quads.vertex.size() &&
           std::all_of(quads.mirror.begin(), quads.mirror.end(),
                       [&](int v) { return v >= 0 && v < count; }) &&
           (quads.Q.size() == 0 || (quads.Q.minCoeff() >= 0 && quads.Q.maxCoeff() < count));
}

}  // namespace

QuadMesh join_mirrored_quads(const QuadMesh& half, const std::vector<SurfacePoint>& mirrored,
                             const std::vector<char>& is_on_curve) {
    QuadMesh whole;
    const int count = static_cast<int>(half.vertex.size());
    whole.vertex = half.vertex;
    whole.mirror.resize(at(count));
    for (int v = 0; v < count; ++v) {
        if (is_on_curve[at(v)]) {
            whole.mirror[at(v)] = v;
            continue;
        }
        whole.mirror[at(v)] = static_cast<int>(whole.vertex.size());
        whole.vertex.push_back(mirrored[at(v)]);
        whole.mirror.push_back(v);
    }
    whole.Q.resize(2 * half.Q.rows(), 4);
    whole.Q.topRows(half.Q.rows()) = half.Q;
    for (Eigen::Index q = 0; q < half.Q.rows(); ++q) {
        for (int k = 0; k < 4; ++k) {
            whole.Q(half.Q.rows() + q, k) = whole.mirror[at(half.Q(q, (4 - k) % 4))];
        }
    }
    return whole;
}

MirrorReport verify_mirror(const QuadMesh& quads) {
    MirrorReport report;
    report.vertices = static_cast<int>(quads.vertex.size());
    if (!names_vertices(quads)) {
        report.broken_vertices = report.vertices;
        return report;
    }
    const auto& mirror = quads.mirror;
    std::vector<int> chain_edges(mirror.size(), 0);
    std::vector<char> is_on_boundary(mirror.size(), 0);
    std::set<std::array<int, 4>> known;
    std::set<std::pair<int, int>> sides;
    for (Eigen::Index q = 0; q < quads.Q.rows(); ++q) {
        known.insert(from_lowest({quads.Q(q, 0), quads.Q(q, 1), quads.Q(q, 2), quads.Q(q, 3)}));
        for (int k = 0; k < 4; ++k) sides.emplace(quads.Q(q, k), quads.Q(q, (k + 1) % 4));
    }
    for (Eigen::Index q = 0; q < quads.Q.rows(); ++q) {
        std::array<int, 4> image{};
        for (int k = 0; k < 4; ++k) image[at(k)] = mirror[at(quads.Q(q, (4 - k) % 4))];
        if (known.count(from_lowest(image)) == 0) ++report.broken_quads;
    }
    for (const auto& [a, b] : sides) {
        const bool has_twin = sides.count({b, a}) != 0;
        if (!has_twin) is_on_boundary[at(a)] = is_on_boundary[at(b)] = 1;
        if (mirror[at(a)] == a && mirror[at(b)] == b && has_twin) ++chain_edges[at(a)];
    }
    for (int v = 0; v < report.vertices; ++v) {
        if (mirror[at(mirror[at(v)])] != v) ++report.broken_vertices;
        if (mirror[at(v)] != v) continue;
        ++report.fixed_vertices;
        if (chain_edges[at(v)] != (is_on_boundary[at(v)] ? 1 : 2)) ++report.loose_fixed_vertices;
    }
    return report;
}

}  // namespace kinequad
