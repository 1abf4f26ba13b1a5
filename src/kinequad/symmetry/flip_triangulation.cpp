#include "kinequad/symmetry/flip_triangulation.h"

#include <array>
#include <cmath>
#include <utility>

#include "kinequad/core/index.h"

namespace kinequad {
namespace {

/// Cosine of the angle opposite of `across`; defined even where the triangle inequality fails.
double opposite_cosine(double across, double left, double right) {
    return (left * left + right * right - across * across) / (2 * left * right);
}

/// Lengths around edge a-b with opposite corners c and d.
struct Diamond {
    double ab, bc, ca, ad, db;
};

double ptolemy_diagonal(const Diamond& q) { return (q.ca * q.db + q.bc * q.ad) / q.ab; }

double flat_diagonal(const Diamond& q) {
    const auto upper = lay_out_triangle({q.ab, q.bc, q.ca});
    const auto lower = lay_out_triangle({q.ab, q.db, q.ad});
    return std::hypot(upper(0, 2) - lower(0, 2), upper(1, 2) + lower(1, 2));
}

/// Replaces edge a-b of triangles (a, b, c) and (b, a, d) by c-d, in the same six half-edges.
void flip(FlipTriangulation& mesh, int h, double new_length) {
    const int g = mesh.twin[at(h)];
    const int h1 = mesh.next(h);
    const int h2 = mesh.previous(h);
    const int g1 = mesh.next(g);
    const int g2 = mesh.previous(g);
    const int c = mesh.origin[at(h2)];
    const int d = mesh.origin[at(g2)];
    const std::array<std::pair<int, int>, 4> moves = {{{h2, h1}, {g1, h2}, {g2, g1}, {h1, g2}}};
    struct Outer {
        int origin, twin, edge;
    };
    std::array<Outer, 4> outer{};
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t old = at(moves[i].first);
        int twin = mesh.twin[old];
        for (const auto& [from, to] : moves) {
            if (mesh.twin[old] == from) twin = to;
        }
        outer[i] = {mesh.origin[old], twin, mesh.edge[old]};
    }
    for (std::size_t i = 0; i < 4; ++i) {
        const int slot = moves[i].second;
        mesh.origin[at(slot)] = outer[i].origin;
        mesh.twin[at(slot)] = outer[i].twin;
        mesh.edge[at(slot)] = outer[i].edge;
        mesh.half_edge[at(outer[i].edge)] = slot;
        if (outer[i].twin >= 0) mesh.twin[at(outer[i].twin)] = slot;
    }
    mesh.origin[at(h)] = d;
    mesh.origin[at(g)] = c;
    mesh.length[at(mesh.edge[at(h)])] = new_length;
}

}  // namespace

FlipTriangulation make_flip_triangulation(const Topology& topology, const IntrinsicMetric& metric) {
    FlipTriangulation mesh;
    mesh.origin = topology.origin;
    mesh.twin = topology.twin;
    mesh.edge = topology.edge;
    mesh.half_edge = topology.edge_half_edge;
    mesh.length.assign(metric.edge_length.begin(), metric.edge_length.end());
    return mesh;
}

std::array<double, 3> scaled_sides(const FlipTriangulation& mesh, const Eigen::VectorXd& scale,
                                   int t) {
    std::array<double, 3> sides{};
    for (int k = 0; k < 3; ++k) {
        const int h = 3 * t + k;
        sides[at(k)] =
            scale[mesh.origin[at(h)]] * scale[mesh.target(h)] * mesh.length[at(mesh.edge[at(h)])];
    }
    return sides;
}

int flip_to_delaunay(FlipTriangulation& mesh, const Eigen::VectorXd& scale, FlipRule rule) {
    std::vector<int> stack(mesh.half_edge.size());
    for (std::size_t i = 0; i < stack.size(); ++i) stack[i] = static_cast<int>(i);
    std::vector<bool> waits(mesh.half_edge.size(), true);
    const auto scaled = [&](int h) {
        return scale[mesh.origin[at(h)]] * scale[mesh.target(h)] *
               mesh.length[at(mesh.edge[at(h)])];
    };
    const auto unscaled = [&](int h) { return mesh.length[at(mesh.edge[at(h)])]; };
    // Flips end in exact arithmetic; the bound only stops a cycle made of rounding.
    const int bound = 100 * static_cast<int>(mesh.half_edge.size());
    int flips = 0;
    while (!stack.empty() && flips < bound) {
        const int e = stack.back();
        stack.pop_back();
        waits[at(e)] = false;
        const int h = mesh.half_edge[at(e)];
        const int g = h < 0 ? -1 : mesh.twin[at(h)];
        if (g < 0 || h / 3 == g / 3) continue;
        const int h1 = mesh.next(h);
        const int h2 = mesh.previous(h);
        const int g1 = mesh.next(g);
        const int g2 = mesh.previous(g);
        const double across = scaled(h);
        const double cosines = opposite_cosine(across, scaled(h1), scaled(h2)) +
                               opposite_cosine(across, scaled(g1), scaled(g2));
        if (!(cosines < -1e-11)) continue;
        const Diamond sides = {unscaled(h), unscaled(h1), unscaled(h2), unscaled(g1), unscaled(g2)};
        flip(mesh, h, rule == FlipRule::ptolemy ? ptolemy_diagonal(sides) : flat_diagonal(sides));
        ++flips;
        for (const int side : {h1, h2, g1, g2}) {
            const int other = mesh.edge[at(side)];
            if (waits[at(other)]) continue;
            waits[at(other)] = true;
            stack.push_back(other);
        }
    }
    return flips;
}

}  // namespace kinequad
