#pragma once

#include <optional>

#include "kinequad/core/context.h"
#include "kinequad/mesh/refined_mesh.h"
#include "kinequad/mesh/topology.h"
#include "kinequad/pipeline/options.h"

namespace kinequad {

/// A refinement of the mesh `topology` in the pose `V` (n x 3) where it is too coarse to carry the
/// quads that `options` ask for: its edges are long against those of the quads, or a part of it has
/// few triangles, or features (edges) crowd. Nothing where it is fine enough, or, in a symmetric
/// run, where that would not double the triangles. docs/robustness.md, "Coarse input"
std::optional<RefinedMesh> refine_coarse_input(const Topology& topology, const Positions& V,
                                               const std::vector<int>& features,
                                               const Options& options, const Context& context);

}  // namespace kinequad
