#pragma once

#include <vector>

#include "kinequad/field/compute_cross_field.h"

namespace kinequad {

/// The cross field energy in the form that the solvers share. Internal to this stage.
///
/// Across interior edge e from triangle `left[e]` to `right[e]`,
/// `w_e = theta_left + kappa_e + pi/2 p_e - theta_right`; on the boundary `w_e` is a constant: what
/// the fixed cross of the one triangle differs from the edge's direction.
struct FieldProblem {
    int triangle_count = 0;
    int edge_count = 0;
    int vertex_count = 0;
    std::vector<int> left,
        right;  ///< e: triangle of the lower half-edge; of the other, -1 on the boundary
    std::vector<int> tail, head;        ///< e: the lower half-edge runs from `tail` to `head`
    Eigen::VectorXd kappa;              ///< e: radians; 0 on the boundary
    Eigen::VectorXd boundary_residual;  ///< e: w_e on the boundary, else 0
    Eigen::VectorXd defect;             ///< n: angle defect, radians
    Eigen::VectorXd weight;             ///< m: of the soft term, 0 in fixed triangles
    Eigen::VectorXd target;             ///< m: radians, up to quarter turns
    std::vector<bool> fixed;            ///< m: cross is given
    Eigen::VectorXd fixed_angle;        ///< m: radians
    std::vector<int> mirror_edges_at;   ///< n: number of mirror edges at a vertex
    std::vector<double> avoidance;      ///< n: in [0, 1], how much more singularities cost there
    SymmetryTerm symmetry;              ///< weight 0: none
    std::vector<int> component;         ///< m: connected component of a triangle
    std::vector<bool> anchored;         ///< component: has a fixed cross or soft terms that matter
};

/// Gathers connection, constraints and targets. Throws `InputError` (usage) as
/// `compute_cross_field`.
FieldProblem make_field_problem(const Topology& topology, const IntrinsicMetric& metric,
                                const CrossFieldTargets& targets, const CrossFieldOptions& options);

/// A state of the field: angles (m, radians) and period jumps (e, quarter turns).
struct FieldState {
    Eigen::VectorXd angle;
    Eigen::VectorXi period_jump;
};

/// `w_e` of every edge (e), radians.
Eigen::VectorXd edge_residuals(const FieldProblem& problem, const FieldState& state);

/// Singularity index of every vertex (n), in quarters, from the residuals.
Eigen::VectorXi singularity_indices(const FieldProblem& problem, const Eigen::VectorXd& residual);

/// What the sum of a cross's angle and that of its image misses, up to quarter turns; radians.
double symmetry_residual(const FieldProblem& problem, const Eigen::VectorXd& angle, int t);

/// The energy: squared residuals of interior edges plus soft terms and the symmetry term, each at
/// its nearest quarter turn.
double field_energy(const FieldProblem& problem, const FieldState& state,
                    const Eigen::VectorXd& residual);

/// The integer k for which `angle - k pi/2` is closest to zero.
int nearest_quarter(double angle);

/// Period jumps that bring every `w_e` closest to zero at the given angles (m); 0 on the boundary.
Eigen::VectorXi nearest_period_jumps(const FieldProblem& problem, const Eigen::VectorXd& angle);

}  // namespace kinequad
