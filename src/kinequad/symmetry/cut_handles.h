#pragma once

#include <vector>

#include "kinequad/core/context.h"
#include "kinequad/mesh/topology.h"

namespace kinequad {

/// Triangles over the old vertices and the copies that follow them.
struct CutSurface {
    Triangles F;
    int vertex_count = 0;
};

/// Cuts a closed surface along short loops that do not separate it, one for each handle. `F` m x 3
/// over `vertex_count` vertices; `side` holds the length of every half-edge (3m), infinite where no
/// cut may run. Loops are found by tree and cotree from a few far-apart vertices, then from those
/// of the best loop until it gets no shorter [Eppstein 2003]. Stops early where no loop is found.
CutSurface cut_handles(const Triangles& F, int vertex_count, const std::vector<double>& side,
                       const Context& context);

}  // namespace kinequad
