#include "kinequad/extract/integer_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"

namespace kinequad::extraction {
namespace {

constexpr std::int64_t one = GridMap::one;

std::int64_t floor_cell(std::int64_t x) { return x >> GridMap::fraction_bits; }
std::int64_t ceil_cell(std::int64_t x) { return -floor_cell(-x); }

Wide floor_divide(Wide a, Wide positive) {
    const Wide quotient = a / positive;
    return quotient * positive > a ? quotient - 1 : quotient;
}

/// A coordinate with its axes exchanged where `exchange` is set.
Coordinate exchanged(Coordinate z, bool exchange) { return exchange ? Coordinate{z.v, z.u} : z; }

/// Integer points strictly between `a` and `b`, in this order.
std::vector<Coordinate> points_between(Coordinate a, Coordinate b) {
    std::vector<Coordinate> points;
    const std::int64_t width = std::abs(b.u - a.u);
    const std::int64_t height = std::abs(b.v - a.v);
    // The fewest integer lines are met along the shorter extent, where there is one.
    const bool by_v = width == 0 || (height != 0 && height < width);
    const Coordinate from = exchanged(a, by_v);
    const Coordinate to = exchanged(b, by_v);
    const std::int64_t sign = to.u > from.u ? 1 : -1;
    const std::int64_t first = sign > 0 ? floor_cell(from.u) + 1 : -(ceil_cell(from.u) - 1);
    const std::int64_t last = sign > 0 ? ceil_cell(to.u) - 1 : -(floor_cell(to.u) + 1);
    for (std::int64_t i = first; i <= last; ++i) {
        const std::int64_t u = sign * i * one;
        const Wide scaled = static_cast<Wide>(to.v - from.v) * (u - from.u);
        const Wide run = to.u - from.u;
        if (scaled % run != 0) continue;
        const Coordinate z = {u, from.v + static_cast<std::int64_t>(scaled / run)};
        if (is_whole(z)) points.push_back(exchanged(z, by_v));
    }
    return points;
}

/// Integer points strictly inside triangle `t`, row by row.
std::vector<Coordinate> points_inside(const GridMap& map, int t) {
    std::vector<Coordinate> points;
    std::array<Coordinate, 3> z = {corner_of(map, 3 * t), corner_of(map, 3 * t + 1),
                                   corner_of(map, 3 * t + 2)};
    const auto [low_u, high_u] = std::minmax({z[0].u, z[1].u, z[2].u});
    const auto [low_v, high_v] = std::minmax({z[0].v, z[1].v, z[2].v});
    const bool by_u = high_u - low_u < high_v - low_v;
    for (Coordinate& corner : z) corner = exchanged(corner, by_u);
    // Exchanging the axes turns the triangle over; read it the other way round.
    if (by_u) std::swap(z[1], z[2]);
    const std::int64_t first_row = floor_cell(by_u ? low_u : low_v) + 1;
    const std::int64_t last_row = ceil_cell(by_u ? high_u : high_v) - 1;
    const std::int64_t low_column = floor_cell(by_u ? low_v : low_u) + 1;
    const std::int64_t high_column = ceil_cell(by_u ? high_v : high_u) - 1;
    if (low_column > high_column) return points;
    for (std::int64_t row = first_row; row <= last_row; ++row) {
        Wide low = low_column;
        Wide high = high_column;
        for (std::size_t k = 0; k < 3; ++k) {
            // A point of the row is left of the side where rise * (u - from.u) < reach; that holds
            // along all of the row where the side is parallel to it.
            const Coordinate from = z[k];
            const Coordinate side = minus(z[(k + 1) % 3], from);
            const Wide rise = side.v;
            const Wide reach = static_cast<Wide>(side.u) * (row * one - from.v);
            const Wide bound = from.u * rise + reach;
            if (rise > 0) {
                high = std::min(high, -floor_divide(-bound, rise * one) - 1);
            } else if (rise < 0) {
                low = std::max(low, floor_divide(-bound, -rise * one) + 1);
            }
        }
        for (Wide column = low; column <= high; ++column) {
            const Coordinate found = {static_cast<std::int64_t>(column) * one, row * one};
            points.push_back(exchanged(found, by_u));
        }
    }
    return points;
}

class Finder {
public:
    explicit Finder(const GridMap& map) : map_(map) {
        points_.at_vertex.assign(at(map.topology.vertex_count), -1);
        points_.on_edge.resize(at(map.topology.edge_count));
        points_.in_triangle.resize(at(map.topology.triangle_count));
    }

    IntegerPoints run() {
        for (int t = 0; t < map_.topology.triangle_count; ++t) {
            for (int h = 3 * t; h < 3 * t + 3; ++h) add_vertex(map_.topology.origin[at(h)]);
            for (int h = 3 * t; h < 3 * t + 3; ++h) {
                if (owner_of(h) == h) add_edge(h);
            }
            add_triangle(t);
        }
        points_.point.push_back({.first_port = static_cast<int>(points_.port.size())});
        return std::move(points_);
    }

private:
    int owner_of(int h) const {
        return map_.topology.edge_half_edge[at(map_.topology.edge[at(h)])];
    }

    int add_point(Place place, int half_edge, Coordinate where) {
        points_.point.push_back({place, half_edge, where, static_cast<int>(points_.port.size())});
        return static_cast<int>(points_.point.size()) - 1;
    }

    void add_vertex(int v) {
        int& point = points_.at_vertex[at(v)];
        const int start = map_.topology.vertex_half_edge[at(v)];
        const Coordinate where = corner_of(map_, start);
        if (point >= 0 || !is_whole(where)) return;
        point = add_point(Place::vertex, start, where);
        int h = start;
        do {
            add_sector(point, h);
            h = map_.topology.rotate_counter_clockwise(h);
        } while (h >= 0 && h != start);
    }

    /// Ports in the sector of corner `h`, counter-clockwise; a sector is less than a half turn, so
    /// it has at most two, and the last side counts only where no other corner follows.
    void add_sector(int point, int h) {
        std::array<bool, 4> holds{};
        for (int k = 0; k < 4; ++k) holds[at(k)] = is_in_sector(view_corner(map_, h, k));
        for (int k = 0; k < 4; ++k) {
            if (!holds[at(k)] || holds[at((k + 3) % 4)]) continue;
            points_.port.push_back({point, h, k});
            if (holds[at((k + 1) % 4)]) points_.port.push_back({point, h, (k + 1) % 4});
        }
        if (map_.topology.twin[at(Topology::previous(h))] >= 0) return;
        for (int k = 0; k < 4; ++k) {
            if (is_along_last_side(view_corner(map_, h, k))) points_.port.push_back({point, h, k});
        }
    }

    void add_edge(int h) {
        const Coordinate from = corner_of(map_, h);
        const Coordinate to = corner_of(map_, Topology::next(h));
        PointRange& range = points_.on_edge[at(map_.topology.edge[at(h)])];
        range.begin = static_cast<int>(points_.point.size());
        const bool on_boundary = map_.topology.twin[at(h)] < 0;
        int first = 0;
        if (on_boundary) {
            while (!is_along_first_side(view_corner(map_, h, first))) ++first;
        }
        for (const Coordinate& where : points_between(from, to)) {
            const int point = add_point(Place::edge, h, where);
            for (int k = first; k < first + (on_boundary ? 3 : 4); ++k) {
                points_.port.push_back({point, h, k & 3});
            }
        }
        range.end = static_cast<int>(points_.point.size());
    }

    void add_triangle(int t) {
        PointRange& range = points_.in_triangle[at(t)];
        range.begin = static_cast<int>(points_.point.size());
        for (const Coordinate& where : points_inside(map_, t)) {
            const int point = add_point(Place::triangle, 3 * t, where);
            for (int k = 0; k < 4; ++k) points_.port.push_back({point, 3 * t, k});
        }
        range.end = static_cast<int>(points_.point.size());
    }

    const GridMap& map_;
    IntegerPoints points_;
};

/// The point at `where` in a range sorted by `before`; -1 where there is none.
template <class Before>
int search(const IntegerPoints& points, PointRange range, Coordinate where, Before before) {
    const auto begin = points.point.begin();
    const auto found = std::lower_bound(
        begin + range.begin, begin + range.end, where,
        [&](const IntegerPoint& point, const Coordinate& z) { return before(point.at, z); });
    if (found == begin + range.end || !(found->at == where)) return -1;
    return static_cast<int>(found - begin);
}

int find_on_edge(const GridMap& map, const IntegerPoints& points, int h, Coordinate where) {
    const Coordinate along = minus(corner_of(map, Topology::next(h)), corner_of(map, h));
    return search(points, points.on_edge[at(map.topology.edge[at(h)])], where,
                  [&](Coordinate a, Coordinate b) {
                      return along.u != 0 ? (along.u > 0 ? a.u < b.u : a.u > b.u)
                                          : (along.v > 0 ? a.v < b.v : a.v > b.v);
                  });
}

int find_in_triangle(const GridMap& map, const IntegerPoints& points, int t, Coordinate where) {
    const auto [a, b, c] =
        std::array{corner_of(map, 3 * t), corner_of(map, 3 * t + 1), corner_of(map, 3 * t + 2)};
    const std::int64_t width = std::max({a.u, b.u, c.u}) - std::min({a.u, b.u, c.u});
    const std::int64_t height = std::max({a.v, b.v, c.v}) - std::min({a.v, b.v, c.v});
    const bool by_u = width < height;
    return search(points, points.in_triangle[at(t)], where, [&](Coordinate x, Coordinate y) {
        return by_u ? std::pair(x.u, x.v) < std::pair(y.u, y.v)
                    : std::pair(x.v, x.u) < std::pair(y.v, y.u);
    });
}

/// The corner's sector leaves its last side to the next corner around the vertex: moves there.
void move_to_owner(const GridMap& map, int& corner, int& direction) {
    const int side = Topology::previous(corner);
    const int other = map.topology.twin[at(side)];
    if (other < 0 || !is_along_last_side(view_corner(map, corner, direction))) return;
    direction = (direction + map.transition[at(side)].rotation) & 3;
    corner = other;
}

}  // namespace

IntegerPoints find_integer_points(const GridMap& map) { return Finder(map).run(); }

int find_port(const GridMap& map, const IntegerPoints& points, Place place, int half_edge,
              Coordinate where, int direction) {
    int point = -1;
    if (place == Place::vertex) {
        point = points.at_vertex[at(map.topology.origin[at(half_edge)])];
        move_to_owner(map, half_edge, direction);
    } else if (place == Place::edge) {
        const int edge = map.topology.edge[at(half_edge)];
        const int owner = map.topology.edge_half_edge[at(edge)];
        if (owner != half_edge) {
            const GridMap::Transition& across = map.transition[at(half_edge)];
            where = across(where);
            direction = (direction + across.rotation) & 3;
            half_edge = owner;
        }
        point = find_on_edge(map, points, half_edge, where);
    } else {
        half_edge -= half_edge % 3;
        point = find_in_triangle(map, points, half_edge / 3, where);
    }
    if (point >= 0) {
        const int first = points.point[at(point)].first_port;
        for (int i = first; i < first + points.port_count_of(point); ++i) {
            const Port& port = points.port[at(i)];
            if (port.half_edge == half_edge && port.direction == direction) return i;
        }
    }
    throw VerificationError(fmt::format(
        "an integer line of the grid map ends in triangle {} without meeting a vertex of "
        "the quad mesh",
        half_edge / 3));
}

}  // namespace kinequad::extraction
