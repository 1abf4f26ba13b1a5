#include "kinequad/symmetry/closed_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/symmetry/cut_handles.h"
#include "kinequad/symmetry/weld_seams.h"

namespace kinequad {
namespace {

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

/// Triangles with the lengths of their half-edges.
struct SidedSurface {
    Triangles F;
    int vertex_count = 0;
    std::vector<double> side;  ///< 3m
};

/// Lengths of the half-edges of a welded surface: both sides of a seam may have measured it.
std::vector<double> measure_sides(const Topology& topology, const IntrinsicMetric& metric,
                                  const SidedSurface& surface) {
    const Topology welded = build_topology(surface.F, surface.vertex_count);
    std::vector<double> side(topology.edge.size());
    for (std::size_t h = 0; h < side.size(); ++h) {
        const std::size_t other = welded.twin[h] < 0 ? h : at(welded.twin[h]);
        side[h] =
            (metric.edge_length[topology.edge[h]] + metric.edge_length[topology.edge[other]]) / 2;
    }
    return side;
}

/// Fills every hole with a cone, and returns the half-edge below each of its triangles.
std::vector<int> fill_holes(SidedSurface& surface) {
    const Topology open = build_topology(surface.F, surface.vertex_count);
    const std::vector<std::vector<int>> loops = boundary_loops(open);
    std::vector<int> below;
    for (const std::vector<int>& loop : loops) below.insert(below.end(), loop.begin(), loop.end());
    Eigen::Index row = surface.F.rows();
    surface.F.conservativeResize(row + static_cast<Eigen::Index>(below.size()), 3);
    for (const std::vector<int>& loop : loops) {
        std::vector<double> lengths;
        lengths.reserve(loop.size());
        for (const int h : loop) lengths.push_back(surface.side[at(h)]);
        const double spoke = inscribing_radius(lengths);
        for (const int h : loop) {
            surface.F.row(row++) << open.target(h), open.origin[at(h)], surface.vertex_count;
            surface.side.insert(surface.side.end(), {surface.side[at(h)], spoke, spoke});
        }
        ++surface.vertex_count;
    }
    return below;
}

void require_sphere(const Topology& topology) {
    const SurfaceCounts counts = count_surface(topology);
    if (counts.components != 1) {
        throw InputError(
            InputFault::symmetry,
            fmt::format("the surface has {} components, which landmarks do not match; leave the "
                        "landmarks out, so that a pose that a plane mirrors is looked for, or join "
                        "the components",
                        counts.components));
    }
    if (counts.euler_characteristic != 2) {
        throw InputError(InputFault::symmetry,
                         fmt::format("the surface has genus {} that no short cut removes; remove "
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
                            const IntrinsicMetric& metric, const Context& context) {
    ClosedSurface closed;
    closed.triangle_count = topology.triangle_count;
    closed.vertex = weld_seams(mesh, topology);
    SidedSurface surface;
    surface.F = renumber(mesh.F, closed.vertex);
    surface.vertex_count = topology.vertex_count;
    surface.side = measure_sides(topology, metric, surface);
    std::vector<int> caps = fill_holes(surface);
    const Topology filled = build_topology(surface.F, surface.vertex_count);
    if (count_surface(filled).components == 1 && count_surface(filled).euler_characteristic < 2) {
        context.write_log(LogLevel::info, "symmetry: the surface has handles; they are cut");
        std::vector<double> cost = surface.side;
        for (std::size_t h = 0; h < cost.size(); ++h) {
            // A cut along a filled hole would have no triangle of the input on one side.
            const int last = 3 * topology.triangle_count;
            const bool is_filling = static_cast<int>(h) >= last || filled.twin[h] >= last;
            if (is_filling) cost[h] = std::numeric_limits<double>::infinity();
        }
        CutSurface cut = cut_handles(surface.F, surface.vertex_count, cost, context);
        surface.F = std::move(cut.F);
        surface.vertex_count = cut.vertex_count;
        const std::vector<int> more = fill_holes(surface);
        caps.insert(caps.end(), more.begin(), more.end());
        // A vertex on a cut has two copies; it goes with the one that kept its number.
    }
    closed.cap_half_edge = std::move(caps);
    closed.F = surface.F;
    closed.topology = build_topology(surface.F, surface.vertex_count);
    require_sphere(closed.topology);
    closed.metric.edge_length.resize(closed.topology.edge_count);
    for (int e = 0; e < closed.topology.edge_count; ++e) {
        closed.metric.edge_length[e] = surface.side[at(closed.topology.edge_half_edge[at(e)])];
    }
    return closed;
}

}  // namespace kinequad
