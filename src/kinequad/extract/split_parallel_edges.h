#pragma once

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
    std::size_t edge_count = 0;
};

/// Whether two edges join the same two vertices, or an edge a vertex with itself.
bool has_parallel_edges(const Cells& cells);

/// The wanted quads, with as few rows of them split lengthwise as it takes for no two edges to join
/// the same two vertices. A row is what one comes to from an edge by crossing quads to their
/// opposite edges; splitting it adds regular vertices only. Where splitting every row once is not
/// enough, parallel edges stay, for `verify_quad_mesh` to find. Throws `VerificationError` where a
/// quad borders on itself. docs/extraction.md
QuadMesh split_parallel_edges(const Cells& doubled);

}  // namespace kinequad::extraction
