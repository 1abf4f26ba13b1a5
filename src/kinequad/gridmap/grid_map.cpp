#include "kinequad/gridmap/grid_map.h"

#include <cmath>
#include <numbers>

#include "kinequad/core/index.h"

namespace kinequad {
namespace {

using Coordinate = GridMap::Coordinate;

Coordinate minus(Coordinate a, Coordinate b) { return {a.u - b.u, a.v - b.v}; }

bool is_whole(std::int64_t value) { return (value & (GridMap::one - 1)) == 0; }
bool is_whole(Coordinate z) { return is_whole(z.u) && is_whole(z.v); }

/// Sign of the area of the image of triangle `t`, exact.
bool is_positive(const GridMap& map, std::size_t t) {
    const Coordinate a = minus(map.corner[3 * t + 1], map.corner[3 * t]);
    const Coordinate b = minus(map.corner[3 * t + 2], map.corner[3 * t]);
    return static_cast<__int128>(a.u) * b.v - static_cast<__int128>(a.v) * b.u > 0;
}

double corner_angle(const GridMap& map, int half_edge) {
    const auto corner = [&](int h) { return map.corner[at(h)]; };
    const Coordinate a = minus(corner(Topology::next(half_edge)), corner(half_edge));
    const Coordinate b = minus(corner(Topology::previous(half_edge)), corner(half_edge));
    const auto real = [](std::int64_t x) { return static_cast<double>(x); };
    return std::atan2(real(a.u) * real(b.v) - real(a.v) * real(b.u),
                      real(a.u) * real(b.u) + real(a.v) * real(b.v));
}

}  // namespace

Coordinate rotate(Coordinate z, int quarters) {
    switch (quarters & 3) {
        case 1:
            return {-z.v, z.u};
        case 2:
            return {-z.u, -z.v};
        case 3:
            return {z.v, -z.u};
        default:
            return z;
    }
}

Coordinate GridMap::Transition::operator()(Coordinate z) const {
    const Coordinate turned = rotate(z, rotation);
    return {turned.u + translation.u, turned.v + translation.v};
}

bool GridMapReport::valid() const {
    return flipped_triangles == 0 && broken_transitions == 0 && fractional_translations == 0 &&
           fractional_singularities == 0 && wrong_cone_angles == 0 && unaligned_edges == 0;
}

GridMapReport verify_grid_map(const GridMap& map) {
    GridMapReport report;
    const Topology& topology = map.topology;
    const auto triangles = static_cast<std::size_t>(topology.triangle_count);
    for (std::size_t t = 0; t < triangles; ++t)
        report.flipped_triangles += is_positive(map, t) ? 0 : 1;

    for (std::size_t h = 0; h < 3 * triangles; ++h) {
        const Coordinate from = map.corner[h];
        const Coordinate to = map.corner[at(Topology::next(static_cast<int>(h)))];
        if (topology.twin[h] < 0 || (!map.is_line.empty() && map.is_line[h])) {
            const bool on_line =
                (from.u == to.u && is_whole(from.u)) || (from.v == to.v && is_whole(from.v));
            report.unaligned_edges += on_line ? 0 : 1;
        }
        if (topology.twin[h] < 0) continue;
        const auto other = static_cast<std::size_t>(topology.twin[h]);
        const GridMap::Transition& across = map.transition[h];
        report.fractional_translations += is_whole(across.translation) ? 0 : 1;
        const bool matches =
            across(from) == map.corner[at(Topology::next(static_cast<int>(other)))] &&
            across(to) == map.corner[other];
        report.broken_transitions += matches ? 0 : 1;
    }

    for (int v = 0; v < topology.vertex_count; ++v) {
        if (topology.vertex_half_edge[at(v)] < 0) continue;
        double angle = 0;
        bool whole = true;
        for (const int h : outgoing_half_edges(topology, v)) {
            angle += corner_angle(map, h);
            whole = whole && is_whole(map.corner[at(h)]);
        }
        const int quarters = (topology.is_boundary_vertex(v) ? 2 : 4) - map.index[v];
        report.wrong_cone_angles += std::abs(angle - quarters * std::numbers::pi / 2) < 0.1 ? 0 : 1;
        report.fractional_singularities += map.index[v] != 0 && !whole ? 1 : 0;
    }
    return report;
}

}  // namespace kinequad
