#pragma once

#include <vector>

#include "kinequad/extract/quad_mesh.h"
#include "kinequad/field/compute_cross_field.h"
#include "kinequad/mesh/intrinsic_metric.h"
#include "kinequad/symmetry/symmetric_half.h"

namespace kinequad {

/// The surface that field, map and quads are solved on: the input, or one half of it up to the
/// stationary curve.
struct Domain {
    /// Its triangles over the input's. `mirrored` is empty where the domain is no half.
    SymmetricHalf surface;
    Topology topology;                  ///< of `surface.mesh`
    IntrinsicMetric metric;             ///< that the field and the map are made for
    std::vector<int> feature_edges;     ///< edges inside that become lines of the quad mesh
    std::vector<int> avoided_vertices;  ///< that singularities should keep away from
    /// Directions that crosses have to keep, beside edges.
    std::vector<FixedDirection> fixed_directions;

    bool is_half() const { return !surface.mirrored.empty(); }
    /// Edges of the stationary curve, ascending: on the boundary of a half, else inside.
    std::vector<int> curve_edges() const;
};

/// Which vertices (v) of quads on a half, given in its triangles, lie on the stationary curve.
std::vector<char> curve_vertices(const QuadMesh& quads, const Domain& domain);

}  // namespace kinequad
