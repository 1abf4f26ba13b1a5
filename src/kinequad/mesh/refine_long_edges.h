#pragma once

#include <vector>

#include "kinequad/core/context.h"
#include "kinequad/mesh/intrinsic_metric.h"
#include "kinequad/mesh/refined_mesh.h"

namespace kinequad {

/// How fine a mesh has to be. docs/robustness.md, "Coarse input"
struct RefineOptions {
    double longest_edge = 0;   ///< no edge stays longer than this, in units of the input; above 0
    int least_triangles = 64;  ///< of every connected part
    int most_triangles = 4'000'000;  ///< refinement ends there
    std::vector<int> lines = {};     ///< edges inside that are treated as the boundary is
};

/// Splits edges in the middle, the longest first, until none is longer than wanted, every connected
/// part has triangles enough, and no edge inside joins two vertices of the boundary or of
/// lines without being one. Vertices of
/// the input keep their numbers. Within a triangle of the input the new ones are Delaunay. `metric`
/// are the lengths over the edges of `topology`.
RefinedMesh refine_long_edges(const Topology& topology, const IntrinsicMetric& metric,
                              const RefineOptions& options, const Context& context);

}  // namespace kinequad
