#pragma once

#include <vector>

#include "kinequad/core/index.h"
#include "kinequad/extract/chart.h"

namespace kinequad::extraction {

/// What of the triangulation holds an integer point in its interior.
enum class Place { vertex, edge, triangle };

/// A point of the surface with integer coordinates: a vertex of the quad mesh.
struct IntegerPoint {
    Place place = Place::triangle;
    /// Names the place and the chart: a half-edge that leaves the vertex, the half-edge that owns
    /// the edge, or the first half-edge of the triangle.
    int half_edge = -1;
    Coordinate at{};
    int first_port = 0;  ///< its ports are [first_port, first_port of the next point)
};

/// A direction in which a quad edge leaves an integer point.
struct Port {
    int point = -1;
    int half_edge =
        -1;  ///< names the chart; at a vertex, the corner whose sector holds the direction
    int direction = 0;  ///< i^direction in that chart
};

/// Ids of the points on one edge or in one triangle.
struct PointRange {
    int begin = 0;
    int end = 0;
};

/// All integer points of a map with their ports, counter-clockwise around every point. Around a
/// point on the boundary they start and end with the two directions along the boundary.
struct IntegerPoints {
    std::vector<IntegerPoint> point;  ///< p + 1; the last one only closes the range of ports
    std::vector<Port> port;
    std::vector<int> at_vertex;           ///< n': point at a mesh vertex, or -1
    std::vector<PointRange> on_edge;      ///< e': in the order of the half-edge that owns the edge
    std::vector<PointRange> in_triangle;  ///< m': in lexicographic order of (u, v) or of (v, u)

    int count() const { return static_cast<int>(point.size()) - 1; }
    int port_count_of(int p) const { return point[at(p) + 1].first_port - point[at(p)].first_port; }
};

/// Finds and classifies all integer points exactly, numbered in the order of the triangles: first
/// those at the corners of a triangle, then those on its edges, then those inside. Expects a map
/// that passed `require_extractable`.
IntegerPoints find_integer_points(const GridMap& map);

/// The port of the point at `where`, seen from the chart of the triangle of `half_edge`, that
/// leaves it in direction i^`direction`; `half_edge` names the corner, edge or triangle as `place`
/// says. Throws `VerificationError` where there is none.
int find_port(const GridMap& map, const IntegerPoints& points, Place place, int half_edge,
              Coordinate where, int direction);

}  // namespace kinequad::extraction
