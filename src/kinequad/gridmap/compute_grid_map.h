#pragma once

#include <vector>

#include "kinequad/core/context.h"
#include "kinequad/field/cross_field.h"
#include "kinequad/gridmap/grid_map.h"
#include "kinequad/mesh/intrinsic_metric.h"

namespace kinequad {

struct GridMapOptions {
    /// Wanted number of vertices of the quad mesh; used where `edge_length` is 0.
    int vertex_count = 5000;
    /// Wanted edge length of the quads, in units of the input; 0 to go by `vertex_count`.
    double edge_length = 0;
    /// Edges inside the surface that become integer lines, and so chains of quad edges; the field
    /// has to be aligned with them.
    std::vector<int> line_edges = {};
    /// The same for edges that are given up one by one where no map has them as lines.
    std::vector<int> feature_edges = {};
};

/// Edge length at which a surface is covered by about `vertex_count` quad vertices.
double edge_length_for(const Topology& topology, const IntrinsicMetric& metric, int vertex_count);

/// Computes an integer-grid map along a cross field: no triangle is flipped, singular vertices,
/// the boundary and the wanted lines lie on the integer grid. The input is refined where
/// singularities crowd. Throws `GridMapError` where no such map is found, saying what stood in the
/// way. docs/gridmap.md
GridMap compute_grid_map(const Topology& topology, const IntrinsicMetric& metric,
                         const CrossField& field, const GridMapOptions& options,
                         const Context& context);

}  // namespace kinequad
