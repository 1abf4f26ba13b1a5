#pragma once

#include <array>
#include <vector>

#include "kinequad/core/types.h"

namespace kinequad {

// The connectivity of triangles that may be joined in any way, for checks and repair. Half-edge and
// corner 3 t + k are those of `Topology`; `triangles` lists those that take part, which name three
// different vertices each.

/// An edge a < b with all half-edges along it, ascending.
struct EdgeFan {
    int a = -1;
    int b = -1;
    std::vector<int> half_edges;
    /// Whether any two of them run the same way.
    bool runs_one_way(const Triangles& F) const;
};

/// All edges, in the order of their lowest half-edge.
std::vector<EdgeFan> find_edge_fans(const Triangles& F, const std::vector<int>& triangles);

/// {earlier, later}: triangles with the same three vertices, whichever way round.
std::vector<std::array<int, 2>> find_duplicate_triangles(const Triangles& F,
                                                         const std::vector<int>& triangles);

/// The corners around each vertex, grouped into fans: those that are joined by edges.
struct FanCorners {
    std::vector<int> fan;  ///< 3m: lowest corner of the fan of a corner; -1 of one that is left out
    std::vector<int> vertices_with_several_fans(const Triangles& F, int vertex_count) const;
};
FanCorners group_corners(const Triangles& F, const std::vector<int>& triangles);

/// How connected parts are to be oriented: parts are connected by edges of two triangles.
struct PartOrientation {
    std::vector<char> is_turned;    ///< m: nonzero where a triangle is to be turned over, the fewer
    std::vector<int> unorientable;  ///< lowest triangle of each part that has one side only
};
PartOrientation orient_parts(const Triangles& F, const std::vector<int>& triangles);

}  // namespace kinequad
