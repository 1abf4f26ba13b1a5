#include "kinequad/symmetry/closed_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "kinequad/core/error.h"
#include "kinequad/symmetry/weld_seams.h"

namespace kinequad {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Triangles renumber(const Triangles& F, const std::vector<int>& vertex) {
    Triangles result = F;
    for (Eigen::Index i = 0; i < F.size(); ++i) result.data()[i] = vertex[at(F.data()[i])];
    return result;
}

/// Radius of the circle on which a closed chain of segments of the given lengths is inscribed.
double inscribing_radius(const std::vector<double>& lengths) {
    const double total = std::accumulate(lengths.begin(), lengths.end(), 0.0);
    const double longest = *std::max_element(lengths.begin(), lengths.end());
    const auto turn = [&](double radius) {
        double sum = 0;
        for (const double length : lengths)
            sum += 2 * std::asin(std::min(1.0, length / 2 / radius));
        return sum;
    };
    double low = longest / 2;
    double high = total;
    // Where one segment dominates the centre would lie outside: a half circle is close enough.
    if (turn(low) < 2 * std::numbers::pi) return 1.001 * low;
    for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        (turn(middle) > 2 * std::numbers::pi ? low : high) = middle;
    }
    return std::max(high, 1.0001 * longest / 2);
}

void require_sphere(const Topology& topology) {
    const SurfaceCounts counts = count_surface(topology);
    if (counts.components != 1) {
        throw InputError(
            InputFault::symmetry,
            fmt::format("the surface has {} components, which landmarks alone do not match; join "
                        "them, or bring a mirror-symmetric rest shape or frame",
                        counts.components));
    }
    if (counts.euler_characteristic != 2) {
        throw InputError(
            InputFault::symmetry,
            fmt::format("the surface has genus {}, but a map from landmarks needs genus 0; remove "
                        "the handles, or bring a mirror-symmetric rest shape or frame",
                        (2 - counts.euler_characteristic) / 2));
    }
}

}  // namespace

SurfacePoint ClosedSurface::to_input(const SurfacePoint& point) const {
    if (point.triangle < triangle_count) return point;
    // A cone triangle is (b, a, apex) over the input's boundary half-edge from a to b.
    const int h = cap_half_edge[at(point.triangle - triangle_count)];
    const double sum = point.barycentric[0] + point.barycentric[1];
    const double share = sum > 0 ? point.barycentric[0] / sum : 0.5;
    SurfacePoint result{h / 3, Vector3::Zero()};
    result.barycentric[h % 3] = 1 - share;
    result.barycentric[Topology::next(h) % 3] = share;
    return result;
}

ClosedSurface close_surface(const TriangleMesh& mesh, const Topology& topology,
                            const IntrinsicMetric& metric) {
    ClosedSurface closed;
    closed.triangle_count = topology.triangle_count;
    closed.vertex = weld_seams(mesh, topology);
    closed.F = renumber(mesh.F, closed.vertex);
    int vertex_count = topology.vertex_count;
    const Topology open = build_topology(closed.F, vertex_count);
    const std::vector<std::vector<int>> loops = boundary_loops(open);
    std::vector<double> spoke;
    for (const std::vector<int>& loop : loops) {
        std::vector<double> lengths;
        for (const int h : loop) lengths.push_back(metric.edge_length[topology.edge[at(h)]]);
        spoke.push_back(inscribing_radius(lengths));
        closed.cap_half_edge.insert(closed.cap_half_edge.end(), loop.begin(), loop.end());
    }
    closed.F.conservativeResize(topology.triangle_count + int(closed.cap_half_edge.size()), 3);
    int row = topology.triangle_count;
    for (const std::vector<int>& loop : loops) {
        for (const int h : loop) {
            closed.F.row(row++) << open.target(h), open.origin[at(h)], vertex_count;
        }
        ++vertex_count;
    }
    closed.topology = build_topology(closed.F, vertex_count);
    require_sphere(closed.topology);
    closed.metric.edge_length.resize(closed.topology.edge_count);
    const int inner = 3 * topology.triangle_count;
    for (int e = 0; e < closed.topology.edge_count; ++e) {
        const int h = closed.topology.edge_half_edge[at(e)];
        if (h < inner) {
            const int other = closed.topology.twin[at(h)];
            const int same = other >= 0 && other < inner ? other : h;
            // Both sides of a seam may have measured it.
            closed.metric.edge_length[e] = (metric.edge_length[topology.edge[at(h)]] +
                                            metric.edge_length[topology.edge[at(same)]]) /
                                           2;
            continue;
        }
        const int apex = std::max(closed.topology.origin[at(h)], closed.topology.target(h));
        closed.metric.edge_length[e] = spoke[at(apex - topology.vertex_count)];
    }
    return closed;
}

}  // namespace kinequad
