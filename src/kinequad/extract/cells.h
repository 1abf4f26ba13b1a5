#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "kinequad/extract/quad_mesh.h"

namespace kinequad::extraction {

/// The vertices, edges and quads of a map.
struct Cells {
    QuadMesh mesh;
    /// v: odd coordinates of a vertex. In a map with two cells for one along both axes: 0 at the
    /// wanted vertices, 1 in the middle of their edges, 2 in the middle of their quads.
    std::vector<char> odd_coordinates;
    std::vector<char> is_on_line;  ///< v: on a line that the map has to keep, or on the boundary
    std::size_t edge_count = 0;
};

/// A wanted quad in a map with two cells for one along both axes: its corners, the middles of its
/// edges (k from corner k to k + 1), which tell edges between the same two vertices apart, and its
/// centre.
struct WantedQuad {
    std::array<int, 4> corner;
    std::array<int, 4> middle;
    int centre;
};

/// Whether two edges join the same two vertices, or an edge a vertex with itself.
bool has_parallel_edges(const Cells& cells);

/// Puts the four cells around every centre of `doubled` together, a map with two cells for one
/// along both axes. Throws `VerificationError` where a quad borders on itself.
std::vector<WantedQuad> gather_quads(const Cells& doubled);

/// The mesh of `quads`, whose corners are vertices of `points`; those without a quad are left out.
QuadMesh mesh_of(const std::vector<std::array<int, 4>>& quads,
                 const std::vector<SurfacePoint>& points);

}  // namespace kinequad::extraction
