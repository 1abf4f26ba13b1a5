#include "kinequad/extract/trace_port.h"

#include <fmt/format.h>

#include <array>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"

namespace kinequad::extraction {
namespace {

/// What the walk is about to cross.
enum class Stage {
    triangle,  ///< the interior of the triangle of `half_edge`
    forward,   ///< `half_edge`, from its origin to its target
    backward,  ///< `half_edge`, from its target to its origin
    vertex     ///< the origin of `half_edge`, which is no integer point
};

/// A walk as seen from the chart of the triangle of `half_edge`.
struct Walk {
    Stage stage;
    int half_edge;
    Coordinate start;  ///< the integer point that the walk comes from
    int direction;
};

class Tracer {
public:
    Tracer(const GridMap& map, const IntegerPoints& points) : map_(map), points_(points) {}

    int run(int port, std::int64_t step_limit) {
        begin(port);
        for (std::int64_t step = 0; step < step_limit; ++step) {
            const int arrived = walk_.stage == Stage::triangle ? cross_triangle()
                                : walk_.stage == Stage::vertex ? pass_vertex()
                                                               : follow_edge();
            if (arrived >= 0) return arrived;
        }
        fail("does not end");
    }

private:
    [[noreturn]] void fail(const char* what) const {
        throw VerificationError(fmt::format(
            "an integer line of the grid map through triangle {} {}", walk_.half_edge / 3, what));
    }

    void begin(int port) {
        const Port& from = points_.port[at(port)];
        const IntegerPoint& point = points_.point[at(from.point)];
        walk_ = {Stage::triangle, from.half_edge, point.at, from.direction};
        if (point.place == Place::triangle) return;
        const CornerView view = view_corner(map_, from.half_edge, from.direction);
        if (point.place == Place::vertex) {
            walk_.start = corner_of(map_, from.half_edge);
            enter_sector(view);
        } else if (view.first.v == 0) {
            walk_.stage = view.first.u > 0 ? Stage::forward : Stage::backward;
        } else if (view.first.v > 0) {
            cross_edge(from.half_edge);
        }
    }

    /// Goes on from the corner `walk_.half_edge`, whose closed sector holds the direction.
    void enter_sector(const CornerView& view) {
        walk_.stage = Stage::triangle;
        if (is_along_first_side(view)) {
            walk_.stage = Stage::forward;
        } else if (is_along_last_side(view)) {
            walk_.stage = Stage::backward;
            walk_.half_edge = Topology::previous(walk_.half_edge);
        }
    }

    /// Takes the walk over to the chart across `half_edge`.
    void cross_edge(int half_edge) {
        const int other = map_.topology.twin[at(half_edge)];
        if (other < 0) fail("leaves the surface");
        const GridMap::Transition& across = map_.transition[at(half_edge)];
        walk_ = {Stage::triangle, other, across(walk_.start),
                 (walk_.direction + across.rotation) & 3};
    }

    Coordinate goal() const {
        const Coordinate step = rotate({GridMap::one, 0}, walk_.direction);
        return {walk_.start.u + step.u, walk_.start.v + step.v};
    }

    int arrive(Place place, int half_edge) const {
        return find_port(map_, points_, place, half_edge, goal(), (walk_.direction + 2) & 3);
    }

    int cross_triangle() {
        const int first = walk_.half_edge - walk_.half_edge % 3;
        std::array<Coordinate, 3> seen;
        for (int k = 0; k < 3; ++k) {
            seen[at(k)] = seen_from(corner_of(map_, first + k), walk_.start, walk_.direction);
        }
        for (int k = 0; k < 3; ++k) {
            const Coordinate a = seen[at(k)];
            const Coordinate b = seen[at((k + 1) % 3)];
            const Coordinate c = seen[at((k + 2) % 3)];
            const int h = first + k;
            if (a.v < 0 && b.v > 0) {
                // The line leaves through h; the goal lies before, on or behind it.
                const Wide side = cross(minus(b, a), minus({GridMap::one, 0}, a));
                if (side > 0) return arrive(Place::triangle, h);
                if (side == 0) return arrive(Place::edge, h);
                cross_edge(h);
                return -1;
            }
            if (a.v == 0 && b.v > 0 && c.v < 0) {
                if (a.u > GridMap::one) return arrive(Place::triangle, h);
                if (a.u == GridMap::one) return arrive(Place::vertex, h);
                walk_.stage = Stage::vertex;
                walk_.half_edge = h;
                return -1;
            }
        }
        fail("misses it");
    }

    int follow_edge() {
        const int h = walk_.half_edge;
        const int end = walk_.stage == Stage::forward ? Topology::next(h) : h;
        const std::int64_t ahead = seen_from(corner_of(map_, end), walk_.start, walk_.direction).u;
        if (ahead > GridMap::one) return arrive(Place::edge, h);
        if (ahead == GridMap::one) return arrive(Place::vertex, end);
        walk_.stage = Stage::vertex;
        walk_.half_edge = end;
        return -1;
    }

    /// Finds the corner of the vertex that the line goes on into. The vertex is regular, so that
    /// one corner alone has the direction in its sector.
    int pass_vertex() {
        const Walk arrival = walk_;
        int h = arrival.half_edge;
        do {
            const CornerView view = view_corner(map_, h, walk_.direction);
            const int side = Topology::previous(h);
            const bool is_last = map_.topology.twin[at(side)] < 0;
            if (is_in_sector(view) || (is_last && is_along_last_side(view))) {
                walk_.half_edge = h;
                enter_sector(view);
                return -1;
            }
            if (is_last) break;
            cross_edge(side);
            h = walk_.half_edge;
        } while (h != arrival.half_edge);
        walk_ = arrival;
        while (map_.topology.twin[at(walk_.half_edge)] >= 0) {
            cross_edge(walk_.half_edge);
            walk_.half_edge = Topology::next(walk_.half_edge);
            if (walk_.half_edge == arrival.half_edge) break;
            const CornerView view = view_corner(map_, walk_.half_edge, walk_.direction);
            if (is_in_sector(view)) {
                enter_sector(view);
                return -1;
            }
        }
        fail("ends at a vertex");
    }

    const GridMap& map_;
    const IntegerPoints& points_;
    Walk walk_{};
};

}  // namespace

int trace_port(const GridMap& map, const IntegerPoints& points, int port, std::int64_t step_limit) {
    return Tracer(map, points).run(port, step_limit);
}

}  // namespace kinequad::extraction
