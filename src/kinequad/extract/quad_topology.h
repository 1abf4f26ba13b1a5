#pragma once

#include <vector>

#include "kinequad/core/index.h"
#include "kinequad/core/types.h"

namespace kinequad {

/// Half-edge connectivity of a manifold, consistently oriented quad mesh, with or without boundary.
/// Half-edge `h = 4 * q + k` runs from corner `k` of quad `q` to corner `k + 1`; it is also the
/// name of that corner. Computed once, passed along, never changed.
struct QuadTopology {
    int vertex_count = 0;
    int quad_count = 0;
    int edge_count = 0;
    std::vector<int> origin;          ///< 4q: vertex that a half-edge starts from
    std::vector<int> twin;            ///< 4q: the half-edge on the other side, -1 on the boundary
    std::vector<int> edge;            ///< 4q: undirected edge of a half-edge
    std::vector<int> edge_half_edge;  ///< e: the lower of the half-edges of an edge
    /// n: a half-edge that leaves the vertex, -1 where the vertex is isolated; on the boundary the
    /// one without twin, the first in counter-clockwise order.
    std::vector<int> vertex_half_edge;
    std::vector<int> valence;  ///< n: number of edges at a vertex
    std::vector<int>
        first_neighbor;  ///< n + 1: where the neighbours of a vertex begin in `neighbor`
    /// 2e: the vertices across the edges of each vertex, counter-clockwise from `vertex_half_edge`;
    /// on the boundary the first and the last are those along the boundary.
    std::vector<int> neighbor;

    static int next(int half_edge) { return half_edge % 4 == 3 ? half_edge - 3 : half_edge + 1; }
    static int previous(int half_edge) {
        return half_edge % 4 == 0 ? half_edge + 3 : half_edge - 1;
    }
    static int quad(int half_edge) { return half_edge / 4; }
    /// Vertex that the half-edge ends at.
    int target(int half_edge) const { return origin[at(next(half_edge))]; }
    /// The next half-edge that leaves the same vertex, counter-clockwise; -1 across the boundary.
    int rotate_counter_clockwise(int half_edge) const { return twin[at(previous(half_edge))]; }
    bool is_boundary_edge(int edge_index) const {
        return twin[at(edge_half_edge[at(edge_index)])] < 0;
    }
    bool is_boundary_vertex(int vertex) const {
        const int half_edge = vertex_half_edge[at(vertex)];
        return half_edge >= 0 && twin[at(half_edge)] < 0;
    }
    /// Whether the vertex is irregular (singular): valence other than 4 inside, other than 3 on the
    /// boundary. Isolated vertices are not.
    bool is_irregular_vertex(int vertex) const {
        return vertex_half_edge[at(vertex)] >= 0 &&
               valence[at(vertex)] != (is_boundary_vertex(vertex) ? 3 : 4);
    }
};

/// Builds the half-edge connectivity of `Q` (q x 4) over `vertex_count` vertices, by sorting alone.
/// Throws `InputError` (mesh), naming the quads or the vertex, where an index is out of range, a
/// quad repeats a vertex, an edge has more than two quads, two neighbours disagree on orientation,
/// or the quads around a vertex form more than one fan.
QuadTopology build_quad_topology(const Quads& Q, int vertex_count);

/// Number of irregular vertices, inside and on the boundary.
int count_irregular_vertices(const QuadTopology& topology);

}  // namespace kinequad
