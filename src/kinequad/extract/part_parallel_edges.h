#pragma once

#include <optional>

#include "kinequad/extract/cells.h"

namespace kinequad::extraction {

/// Quads in which no two edges join the same two vertices.
struct PartedQuads {
    QuadMesh mesh;
    int parted_edges = 0;
};

/// The wanted quads, with all but one of the edges between the same two vertices taken away: the
/// two quads on its sides become three around a new vertex in its middle. That changes no other
/// quad, where `split_parallel_edges` splits whole rows, but makes up to four vertices irregular
/// for each. Edges on lines stay. Nothing where that is not enough. Throws `VerificationError`
/// where a quad borders on itself. docs/extraction.md
std::optional<PartedQuads> part_parallel_edges(const Cells& doubled);

}  // namespace kinequad::extraction
