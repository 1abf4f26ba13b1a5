#include "kinequad/symmetry/unfold_patch.h"

#include <algorithm>

#include "kinequad/core/index.h"

namespace kinequad {
namespace {

/// Corners of the triangle of half-edge `g` when its half-edge lies on the segment from `from` to
/// `to`, left of it.
Eigen::Matrix<double, 2, 3> lay_out_beside(const Topology& topology, const IntrinsicMetric& metric,
                                           int g, const Vector2& from, const Vector2& to) {
    const int t = g / 3;
    const int k = g % 3;
    const std::array<double, 3> sides = side_lengths(topology, metric, t);
    const auto flat =
        lay_out_triangle({sides[at(k)], sides[at((k + 1) % 3)], sides[at((k + 2) % 3)]});
    const double length = (to - from).norm();
    const Vector2 x = length > 0 ? Vector2((to - from) / length) : Vector2::UnitX();
    const Vector2 y(-x[1], x[0]);
    Eigen::Matrix<double, 2, 3> corners;
    corners.col(k) = from;
    corners.col((k + 1) % 3) = to;
    corners.col((k + 2) % 3) = from + flat(0, 2) * x + flat(1, 2) * y;
    return corners;
}

/// Takes the wanted points that lie in the last triangle of the patch, and returns how many.
int take_points(const Topology& topology, const std::vector<SurfacePoint>& wanted,
                UnfoldedPatch& patch) {
    const int t = patch.triangle.back();
    int taken = 0;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        if (patch.is_found[i]) continue;
        Vector2 position = Vector2::Zero();
        bool is_here = true;
        for (int k = 0; k < 3 && is_here; ++k) {
            const double weight = wanted[i].barycentric[k];
            // A weight of rounding size says on which side of an edge the point fell by chance.
            if (weight < 1e-9) continue;
            const int v = topology.origin[at(3 * wanted[i].triangle + k)];
            is_here = false;
            for (int corner = 0; corner < 3; ++corner) {
                if (topology.origin[at(3 * t + corner)] != v) continue;
                position += weight * patch.corners.back().col(corner);
                is_here = true;
            }
        }
        if (!is_here) continue;
        patch.position[i] = position;
        patch.is_found[i] = true;
        ++taken;
    }
    return taken;
}

}  // namespace

UnfoldedPatch unfold_patch(const Topology& topology, const IntrinsicMetric& metric, int middle,
                           const std::vector<SurfacePoint>& wanted, int limit) {
    UnfoldedPatch patch;
    patch.position.resize(wanted.size(), Vector2::Zero());
    patch.is_found.resize(wanted.size(), false);
    patch.triangle.push_back(middle);
    patch.corners.push_back(lay_out_triangle(side_lengths(topology, metric, middle)));
    const auto is_in = [&](int t) {
        return std::find(patch.triangle.begin(), patch.triangle.end(), t) != patch.triangle.end();
    };
    int missing = static_cast<int>(wanted.size()) - take_points(topology, wanted, patch);
    for (std::size_t i = 0; i < patch.triangle.size() && missing > 0; ++i) {
        for (int k = 0; k < 3; ++k) {
            const int g = topology.twin[at(3 * patch.triangle[i] + k)];
            if (g < 0 || is_in(g / 3)) continue;
            if (static_cast<int>(patch.triangle.size()) >= limit) return patch;
            const Vector2 from = patch.corners[i].col((k + 1) % 3);
            const Vector2 to = patch.corners[i].col(k);
            patch.corners.push_back(lay_out_beside(topology, metric, g, from, to));
            patch.triangle.push_back(g / 3);
            missing -= take_points(topology, wanted, patch);
        }
    }
    return patch;
}

}  // namespace kinequad
