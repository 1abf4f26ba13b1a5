#pragma once

#include "kinequad/extract/cells.h"

namespace kinequad::extraction {

/// The wanted quads, with as few rows of them split lengthwise as it takes for no two edges to join
/// the same two vertices. A row is what one comes to from an edge by crossing quads to their
/// opposite edges; splitting it adds regular vertices only. Where splitting every row once is not
/// enough, parallel edges stay, for `verify_quad_mesh` to find. Throws `VerificationError` where a
/// quad borders on itself. docs/extraction.md
QuadMesh split_parallel_edges(const Cells& doubled);

}  // namespace kinequad::extraction
