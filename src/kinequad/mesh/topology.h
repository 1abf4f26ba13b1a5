#pragma once

#include <vector>

#include "kinequad/core/index.h"
#include "kinequad/core/types.h"

namespace kinequad {

/// Half-edge connectivity of a manifold, consistently oriented triangle mesh, with or without
/// boundary. Half-edge `h = 3 * t + k` runs from corner `k` of triangle `t` to corner `k + 1`; it
/// is also the name of that corner. Computed once, passed along, never changed.
struct Topology {
    int vertex_count = 0;
    int triangle_count = 0;
    int edge_count = 0;
    std::vector<int> origin;          ///< 3m: vertex that a half-edge starts from
    std::vector<int> twin;            ///< 3m: the half-edge on the other side, -1 on the boundary
    std::vector<int> edge;            ///< 3m: undirected edge of a half-edge
    std::vector<int> edge_half_edge;  ///< e: the lower of the half-edges of an edge
    /// n: a half-edge that leaves the vertex, -1 where the vertex is isolated. On the boundary it
    /// is the one without twin, the first in counter-clockwise order.
    std::vector<int> vertex_half_edge;

    static int next(int half_edge) { return half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1; }
    static int previous(int half_edge) {
        return half_edge % 3 == 0 ? half_edge + 2 : half_edge - 1;
    }
    static int triangle(int half_edge) { return half_edge / 3; }
    /// Vertex that the half-edge ends at.
    int target(int half_edge) const { return origin[at(next(half_edge))]; }
    /// The next half-edge that leaves the same vertex, counter-clockwise; -1 across the boundary.
    int rotate_counter_clockwise(int half_edge) const { return twin[at(previous(half_edge))]; }
    /// The next half-edge that leaves the same vertex, clockwise; -1 across the boundary.
    int rotate_clockwise(int half_edge) const {
        const int other = twin[at(half_edge)];
        return other < 0 ? -1 : next(other);
    }
    bool is_boundary_edge(int edge_index) const {
        return twin[at(edge_half_edge[at(edge_index)])] < 0;
    }
    bool is_boundary_vertex(int vertex) const {
        const int half_edge = vertex_half_edge[at(vertex)];
        return half_edge >= 0 && twin[at(half_edge)] < 0;
    }
};

/// Builds the half-edge connectivity of `F` (m x 3) over `vertex_count` vertices.
/// Throws `InputError` (mesh), naming the triangles or the vertex, where an index is out of range,
/// a triangle repeats a vertex, an edge has more than two triangles, two neighbours disagree on
/// orientation, or the triangles around a vertex form more than one fan.
Topology build_topology(const Triangles& F, int vertex_count);

/// Half-edges that leave `vertex`, counter-clockwise, starting at `vertex_half_edge`.
std::vector<int> outgoing_half_edges(const Topology& topology, int vertex);

/// Counts of a mesh as a topological surface. Isolated vertices are not counted.
struct SurfaceCounts {
    int vertices = 0;
    int edges = 0;
    int triangles = 0;
    int components = 0;
    int boundary_loops = 0;
    int euler_characteristic = 0;
};

SurfaceCounts count_surface(const Topology& topology);

/// Component of every triangle (m), numbered from 0 in the order of their lowest triangle.
std::vector<int> triangle_components(const Topology& topology);

/// The edges of the boundary, ascending.
std::vector<int> boundary_edges(const Topology& topology);

/// The boundary as closed chains of half-edges, each with the surface on its left, in the order of
/// their lowest half-edge.
std::vector<std::vector<int>> boundary_loops(const Topology& topology);

}  // namespace kinequad
