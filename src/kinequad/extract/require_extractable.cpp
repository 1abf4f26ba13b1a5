#include "kinequad/extract/require_extractable.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/extract/chart.h"

namespace kinequad::extraction {
namespace {

constexpr std::int64_t largest_coordinate = std::int64_t{1} << 60;
/// More cells, or more integer lines through the triangles, than any wanted mesh has; keeps the
/// work on a senseless map within bounds.
constexpr std::int64_t largest_count = 50'000'000;

bool is_within(Coordinate z, std::int64_t bound) {
    return z.u >= -bound && z.u <= bound && z.v >= -bound && z.v <= bound;
}

void check_sizes(const GridMap& map) {
    const auto triangles = static_cast<std::size_t>(map.mesh.F.rows());
    const bool fits =
        at(map.topology.triangle_count) == triangles &&
        map.topology.origin.size() == 3 * triangles &&
        map.topology.vertex_count == map.mesh.vertex_count &&
        map.topology.twin.size() == 3 * triangles && map.topology.edge.size() == 3 * triangles &&
        map.topology.vertex_half_edge.size() == at(map.topology.vertex_count) &&
        std::equal(map.topology.origin.begin(), map.topology.origin.end(), map.mesh.F.data(),
                   map.mesh.F.data() + map.mesh.F.size()) &&
        map.corner.size() == 3 * triangles && map.transition.size() == 3 * triangles &&
        (map.is_line.empty() || map.is_line.size() == 3 * triangles) &&
        map.mesh.parent.size() == triangles && map.mesh.barycentric.rows() == map.mesh.F.size();
    if (!fits) throw GridMapError("the arrays of the grid map do not belong to one mesh");
}

/// Returns the number of integer lines through the triangles, or more.
std::int64_t check_triangles(const GridMap& map) {
    Wide doubled_area = 0;
    std::int64_t lines = 0;
    for (int t = 0; t < map.topology.triangle_count; ++t) {
        const std::array<Coordinate, 3> z = {corner_of(map, 3 * t), corner_of(map, 3 * t + 1),
                                             corner_of(map, 3 * t + 2)};
        for (const Coordinate& corner : z) {
            if (!is_within(corner, largest_coordinate)) {
                throw GridMapError(fmt::format(
                    "triangle {} of the grid map lies out of range; its coordinates must "
                    "stay within 2^30 cells",
                    t));
            }
        }
        const Wide area = cross(minus(z[1], z[0]), minus(z[2], z[0]));
        if (area <= 0) {
            throw GridMapError(fmt::format(
                "triangle {} of the grid map is {}; quads need a map of positive triangles", t,
                area < 0 ? "flipped" : "degenerate"));
        }
        doubled_area += area;
        const auto [low_u, high_u] = std::minmax({z[0].u, z[1].u, z[2].u});
        const auto [low_v, high_v] = std::minmax({z[0].v, z[1].v, z[2].v});
        lines += (high_u - low_u) / GridMap::one + (high_v - low_v) / GridMap::one;
        if (lines > largest_count ||
            doubled_area / 2 / GridMap::one / GridMap::one > static_cast<Wide>(largest_count)) {
            throw GridMapError(fmt::format(
                "the grid map has more than {} cells; ask for fewer quads", largest_count));
        }
    }
    // A side of length x spans at most one integer line more than it has whole cells, in each of
    // the two directions.
    return lines + 2 * std::int64_t{map.topology.triangle_count};
}

void check_transitions(const GridMap& map) {
    for (int h = 0; h < 3 * map.topology.triangle_count; ++h) {
        const Coordinate from = corner_of(map, h);
        const Coordinate to = corner_of(map, Topology::next(h));
        const int other = map.topology.twin[at(h)];
        if (other < 0) {
            constexpr std::int64_t mask = GridMap::one - 1;
            if (!((from.u == to.u && (from.u & mask) == 0) ||
                  (from.v == to.v && (from.v & mask) == 0))) {
                throw GridMapError(
                    fmt::format("boundary edge {}-{} is not on an integer line of the grid map",
                                map.topology.origin[at(h)], map.topology.target(h)));
            }
            continue;
        }
        const GridMap::Transition& across = map.transition[at(h)];
        const bool is_sound = across.rotation >= 0 && across.rotation <= 3 &&
                              is_within(across.translation, 2 * largest_coordinate) &&
                              is_whole(across.translation) &&
                              across(from) == corner_of(map, Topology::next(other)) &&
                              across(to) == corner_of(map, other);
        if (!is_sound) {
            throw GridMapError(fmt::format(
                "the transition of the grid map across edge {}-{} does not hold exactly",
                map.topology.origin[at(h)], map.topology.target(h)));
        }
    }
}

/// A vertex with any other cone than a regular one must be a vertex of the quad mesh.
void check_cones(const GridMap& map) {
    std::vector<int> directions(at(map.topology.vertex_count), 0);
    for (int h = 0; h < 3 * map.topology.triangle_count; ++h) {
        const bool is_last = map.topology.twin[at(Topology::previous(h))] < 0;
        for (int direction = 0; direction < 4; ++direction) {
            const CornerView view = view_corner(map, h, direction);
            const bool counts = is_in_sector(view) || (is_last && is_along_last_side(view));
            directions[at(map.topology.origin[at(h)])] += counts ? 1 : 0;
        }
    }
    for (int v = 0; v < map.topology.vertex_count; ++v) {
        const int half_edge = map.topology.vertex_half_edge[at(v)];
        if (half_edge < 0 || is_whole(corner_of(map, half_edge))) continue;
        const int quarters =
            map.topology.is_boundary_vertex(v) ? directions[at(v)] - 1 : directions[at(v)];
        if (quarters != (map.topology.is_boundary_vertex(v) ? 2 : 4)) {
            throw GridMapError(fmt::format(
                "vertex {} of the grid map has a cone of {} quarter turns off the integer grid", v,
                quarters));
        }
    }
}

}  // namespace

std::int64_t require_extractable(const GridMap& map) {
    check_sizes(map);
    const std::int64_t lines = check_triangles(map);
    check_transitions(map);
    check_cones(map);
    return lines;
}

}  // namespace kinequad::extraction
