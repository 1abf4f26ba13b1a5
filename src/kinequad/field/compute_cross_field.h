#pragma once

#include <vector>

#include "kinequad/core/context.h"
#include "kinequad/field/cross_field.h"
#include "kinequad/field/cross_field_method.h"
#include "kinequad/field/cross_field_targets.h"
#include "kinequad/mesh/intrinsic_metric.h"

namespace kinequad {

/// A direction that the cross of one triangle has to keep.
struct FixedDirection {
    int triangle = -1;
    double angle = 0;  ///< radians in the triangle's frame; a quarter turn more is the same cross
};

/// Draws every cross to that of its mirror image: adds `weight sum_t (theta_image + theta_t -
/// transport_t)^2` to the energy, each at its nearest quarter turn. docs/symmetry.md
struct SymmetryTerm {
    double weight = 0;          ///< in the energy whose smoothness counts 1; 0 for none
    std::vector<int> image;     ///< m: triangle that holds the image of the centre, -1 for none
    Eigen::VectorXd transport;  ///< m: as in `SymmetryMap`, radians
};

struct CrossFieldOptions {
    CrossFieldMethod method = CrossFieldMethod::convex;
    /// What one singularity may cost in energy, in squared radians, weighed when singularities are
    /// moved, made and cancelled (`convex` only).
    double singularity_cost = 0.08;
    /// n: by how much singularities at each vertex inside cost more than that, where quads have no
    /// room for them; empty: nowhere (`convex` only).
    std::vector<double> cost_factor = {};
    /// What each mesh edge that joins two singularities costs beside, in squared radians:
    /// integer-grid maps have no room there; twice that for each quarter beyond the first of one
    /// vertex (`convex` only).
    double adjacency_cost = 0.5;
    /// Wanted edge length of the quads, in units of the input: bumps smaller than it are smoothed
    /// out of the connection before singularities are placed; 0 leaves the connection as it is
    /// (`convex` only).
    double edge_length = 0;
    /// Edges that crosses on both sides are aligned with. Boundary edges always are.
    std::vector<int> feature_edges = {};
    /// Boundary edges across which the surface goes on as its mirror image. Crosses are aligned
    /// with them, but turn evenly along a chain of them where the edges themselves zigzag; what is
    /// singular on them, and so lies on the line of symmetry, is priced as two quarters in one
    /// vertex.
    std::vector<int> mirror_edges = {};
    /// Vertices that singularities should keep away from, such as those beside a line that the quad
    /// mesh has to follow: what is singular there is priced as two quarters in one vertex, less
    /// within one `edge_length` from there.
    std::vector<int> avoided_vertices = {};
    /// Further triangles whose cross is given; a boundary or feature edge has precedence.
    std::vector<FixedDirection> fixed_directions = {};
    /// A symmetry that the field should have; none by default (`convex` only).
    SymmetryTerm symmetry = {};
};

/// Computes a smooth cross field that is drawn to `targets` (m; both vectors may be empty for none)
/// and aligned with the boundary, feature edges and fixed directions.
///
/// Minimises `sum_e w_e^2 + sum_t weight_t (theta_t - target_t)^2`, and the symmetry term, over
/// real angles and integer period jumps; `CrossField::energy` is its value. The result's indices
/// sum to four times the Euler characteristic. Throws `InputError` (usage) where an option names a
/// triangle or edge that does not exist, and `Cancelled`. [Du and Tu, eq. 9; Bommes et al. 2009;
/// Knoppel et al. 2013] docs/field.md
CrossField compute_cross_field(const Topology& topology, const IntrinsicMetric& metric,
                               const CrossFieldTargets& targets, const CrossFieldOptions& options,
                               const Context& context);

}  // namespace kinequad
