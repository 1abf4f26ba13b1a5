#include "kinequad/symmetry/fair_stationary_curve.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "kinequad/core/index.h"
#include "kinequad/solve/sparse_cholesky.h"
#include "kinequad/symmetry/stationary_curve.h"

namespace kinequad {
namespace {

/// `height` (n) after one implicit step of diffusion over the time `length` squared.
Eigen::VectorXd diffuse(const Topology& topology, const IntrinsicMetric& metric,
                        const Eigen::VectorXd& height, double length) {
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd area = Eigen::VectorXd::Zero(topology.vertex_count);
    for (int t = 0; t < topology.triangle_count; ++t) {
        const auto sides = side_lengths(topology, metric, t);
        const auto cotangents = opposite_cotangents(sides);
        const double third = triangle_area(sides) / 3;
        for (int k = 0; k < 3; ++k) {
            const int h = 3 * t + k;
            const int a = topology.origin[at(h)];
            const int b = topology.target(h);
            area[a] += third;
            const double weight = length * length * cotangents[at(k)] / 2;
            entries.insert(entries.end(),
                           {{a, a, weight}, {b, b, weight}, {a, b, -weight}, {b, a, -weight}});
        }
    }
    // Vertices without a triangle keep their height.
    for (int v = 0; v < topology.vertex_count; ++v) {
        if (!(area[v] > 0)) area[v] = 1;
        entries.emplace_back(v, v, area[v]);
    }
    Eigen::SparseMatrix<double> matrix(topology.vertex_count, topology.vertex_count);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return SparseCholesky<double>(matrix).solve(area.cwiseProduct(height));
}

/// Numbers of lines and of closed ones among them.
std::pair<std::size_t, std::size_t> count_lines(const StationaryCurve& curve) {
    const auto closed = std::count_if(
        curve.polylines.begin(), curve.polylines.end(),
        [](const std::vector<SurfacePoint>& line) { return line.front() == line.back(); });
    return {curve.polylines.size(), static_cast<std::size_t>(closed)};
}

}  // namespace

SymmetryMap fair_stationary_curve(const SymmetryMap& map, const Topology& topology,
                                  const IntrinsicMetric& metric, double length) {
    constexpr int most_halvings = 3;
    const auto trace = [&](const Eigen::VectorXd& height) {
        constexpr double shortest_share = 0;
        return trace_stationary_curve(topology, metric, height, topology.triangle_count,
                                      shortest_share);
    };
    SymmetryMap faired = map;
    const auto lines = count_lines(trace(map.height));
    for (int i = 0; i <= most_halvings; ++i, length /= 2) {
        StationaryCurve curve = trace(diffuse(topology, metric, map.height, length));
        if (count_lines(curve) != lines) continue;
        faired.height = std::move(curve.height);
        faired.stationary = std::move(curve.polylines);
        faired.stationary_direction = std::move(curve.directions);
        break;
    }
    return faired;
}

}  // namespace kinequad
