#include "kinequad/extract/extract_quads.h"

#include <fmt/format.h>

#include <cstdlib>
#include <optional>
#include <utility>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/extract/cells.h"
#include "kinequad/extract/integer_points.h"
#include "kinequad/extract/part_parallel_edges.h"
#include "kinequad/extract/require_extractable.h"
#include "kinequad/extract/split_parallel_edges.h"
#include "kinequad/extract/trace_port.h"

namespace kinequad {
namespace {

using namespace extraction;

/// For every port the one at the other end of its quad edge.
std::vector<int> link_ports(const GridMap& map, const IntegerPoints& points,
                            std::int64_t step_limit, const Context& context) {
    std::vector<int> opposite(points.port.size(), -1);
    for (std::size_t p = 0; p < opposite.size(); ++p) {
        if (opposite[p] >= 0) continue;
        if (p % 4096 == 0) {
            context.report_progress("extract",
                                    static_cast<double>(p) / static_cast<double>(opposite.size()));
        }
        const int arrived = trace_port(map, points, static_cast<int>(p), step_limit);
        if (opposite[at(arrived)] >= 0 || arrived == static_cast<int>(p)) {
            throw VerificationError(fmt::format("two quad edges meet in one at vertex {}",
                                                points.port[at(arrived)].point));
        }
        opposite[p] = arrived;
        opposite[at(arrived)] = static_cast<int>(p);
    }
    return opposite;
}

/// The port that follows `port` around the face on its left, -1 where the surface ends on its left.
int next_in_face(const GridMap& map, const IntegerPoints& points, const std::vector<int>& opposite,
                 int port) {
    const int back = opposite[at(port)];
    const int point = points.port[at(back)].point;
    const int first = points.point[at(point)].first_port;
    if (back != first) return back - 1;
    const int half_edge = points.point[at(point)].half_edge;
    const bool on_boundary =
        points.point[at(point)].place != Place::triangle && map.topology.twin[at(half_edge)] < 0;
    return on_boundary ? -1 : first + points.port_count_of(point) - 1;
}

Quads assemble_faces(const GridMap& map, const IntegerPoints& points,
                     const std::vector<int>& opposite) {
    std::vector<int> corners;
    corners.reserve(points.port.size());
    std::vector<bool> is_used(points.port.size(), false);
    for (std::size_t p = 0; p < points.port.size(); ++p) {
        const int start = static_cast<int>(p);
        if (is_used[p] || next_in_face(map, points, opposite, start) < 0) continue;
        int port = start;
        int sides = 0;
        do {
            is_used[at(port)] = true;
            corners.push_back(points.port[at(port)].point);
            port = next_in_face(map, points, opposite, port);
            ++sides;
        } while (port >= 0 && port != start && sides < 4);
        if (port != start || sides != 4) {
            throw VerificationError(fmt::format(
                "the face of the quad mesh at vertex {} does not close after four edges",
                points.port[p].point));
        }
    }
    return Eigen::Map<const Quads>(corners.data(), static_cast<Eigen::Index>(corners.size() / 4),
                                   4);
}

double to_double(Wide x) { return static_cast<double>(x); }

SurfacePoint locate(const GridMap& map, const IntegerPoint& point) {
    const int h = point.half_edge;
    const int t = h / 3;
    const auto row = [&](int half_edge) {
        return Vector3(map.mesh.barycentric.row(half_edge).transpose());
    };
    const int after = Topology::next(h);
    const int before = Topology::previous(h);
    const Coordinate a = minus(corner_of(map, h), point.at);
    const Coordinate b = minus(corner_of(map, after), point.at);
    const Coordinate c = minus(corner_of(map, before), point.at);
    Vector3 weights = row(h);
    if (point.place == Place::edge) {
        // Two corners only, so that a point on an edge of the input stays exactly on it.
        const bool by_u = std::abs(b.u - a.u) > std::abs(b.v - a.v);
        const double near = static_cast<double>(std::abs(by_u ? a.u : a.v));
        const double far = static_cast<double>(std::abs(by_u ? b.u : b.v));
        weights = (far * row(h) + near * row(after)) / (near + far);
    } else if (point.place == Place::triangle) {
        const double at_a = to_double(cross(b, c));
        const double at_b = to_double(cross(c, a));
        const double at_c = to_double(cross(a, b));
        weights = (at_a * row(h) + at_b * row(after) + at_c * row(before)) / (at_a + at_b + at_c);
    }
    weights = weights.cwiseMax(0.0);
    return {map.mesh.parent[at(t)], weights / weights.sum()};
}

/// Whether a point lies on the boundary or on a line of the map.
bool is_on_line(const GridMap& map, const IntegerPoint& point) {
    const auto is_line = [&](int h) {
        return map.topology.twin[at(h)] < 0 || (!map.is_line.empty() && map.is_line[at(h)] != 0);
    };
    if (point.place == Place::triangle) return false;
    if (point.place == Place::edge) return is_line(point.half_edge);
    int h = point.half_edge;
    do {
        if (is_line(h)) return true;
        h = map.topology.rotate_counter_clockwise(h);
    } while (h >= 0 && h != point.half_edge);
    return h < 0;
}

/// The cells of a map, every vertex with the number of its odd coordinates.
Cells extract_cells(const GridMap& map, const Context& context) {
    const std::int64_t lines = require_extractable(map);
    // An integer line crosses a triangle, an edge and a vertex at most once for each line through
    // it.
    const std::int64_t step_limit = 3 * lines + 3;
    const IntegerPoints points = find_integer_points(map);
    const std::vector<int> opposite = link_ports(map, points, step_limit, context);
    Cells cells;
    cells.mesh.Q = assemble_faces(map, points, opposite);
    cells.mesh.vertex.reserve(at(points.count()));
    cells.edge_count = points.port.size() / 2;
    cells.is_on_line.reserve(at(points.count()));
    cells.odd_coordinates.reserve(at(points.count()));
    for (int p = 0; p < points.count(); ++p) {
        const IntegerPoint& point = points.point[at(p)];
        cells.mesh.vertex.push_back(locate(map, point));
        cells.is_on_line.push_back(is_on_line(map, point) ? 1 : 0);
        const auto is_odd = [](std::int64_t x) { return ((x >> GridMap::fraction_bits) & 1) != 0; };
        cells.odd_coordinates.push_back(
            static_cast<char>((is_odd(point.at.u) ? 1 : 0) + (is_odd(point.at.v) ? 1 : 0)));
    }
    return cells;
}

/// The wanted quads without two edges between the same two vertices: with rows split, which leaves
/// all new vertices regular, or where that takes too many, as rows can wind all over the surface,
/// with a few quads changed.
QuadMesh without_parallel_edges(const Cells& doubled) {
    constexpr double most_growth = 1.05;
    constexpr double fair_price = 100;  // quads that are as bad as one edge parted
    QuadMesh split = split_parallel_edges(doubled);
    const double wanted = static_cast<double>(doubled.mesh.Q.rows()) / 4;
    const double added = static_cast<double>(split.Q.rows()) - wanted;
    if (added <= (most_growth - 1) * wanted) return split;
    std::optional<PartedQuads> parted = part_parallel_edges(doubled);
    return parted && fair_price * parted->parted_edges < added ? std::move(parted->mesh)
                                                               : std::move(split);
}

/// The map with two cells for one along both axes.
GridMap doubled(GridMap map) {
    for (Coordinate& corner : map.corner) corner = {2 * corner.u, 2 * corner.v};
    for (GridMap::Transition& transition : map.transition) {
        transition.translation = {2 * transition.translation.u, 2 * transition.translation.v};
    }
    return map;
}

}  // namespace

QuadMesh extract_quads(const GridMap& map, const Context& context) {
    context.report_progress("extract", 0);
    Cells cells = extract_cells(map, context);
    if (has_parallel_edges(cells)) {
        context.write_log(LogLevel::info,
                          "extract: edges join the same two vertices; changing quads there");
        cells.mesh = without_parallel_edges(extract_cells(doubled(map), context));
    }
    context.report_progress("extract", 1);
    return std::move(cells.mesh);
}

}  // namespace kinequad
