#include "kinequad/field/compute_cross_field.h"

#include <numbers>

#include "kinequad/field/angle_solver.h"
#include "kinequad/field/convex_field.h"
#include "kinequad/field/field_problem.h"

namespace kinequad {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The same field with every angle in [-pi/4, pi/4]: the periods take up the quarter turns.
FieldState canonical(const FieldProblem& problem, FieldState state) {
    std::vector<int> turns(at(problem.triangle_count));
    for (int t = 0; t < problem.triangle_count; ++t) {
        turns[at(t)] = nearest_quarter(state.angle[t]);
        state.angle[t] -= std::numbers::pi / 2 * turns[at(t)];
    }
    for (int e = 0; e < problem.edge_count; ++e) {
        if (problem.right[at(e)] < 0) continue;
        state.period_jump[e] += turns[at(problem.left[at(e)])] - turns[at(problem.right[at(e)])];
    }
    return state;
}

}  // namespace

CrossField compute_cross_field(const Topology& topology, const IntrinsicMetric& metric,
                               const CrossFieldTargets& targets, const CrossFieldOptions& options,
                               const Context& context) {
    const FieldProblem problem = make_field_problem(topology, metric, targets, options);
    context.check_cancelled();
    const AngleSolver solver(problem);
    FieldState state;
    state.angle = solve_convex_field(problem, context);
    state.period_jump = nearest_period_jumps(problem, state.angle);
    state = canonical(problem, solver.solve(problem, std::move(state)));

    const Eigen::VectorXd residual = edge_residuals(problem, state);
    CrossField field;
    field.index = singularity_indices(problem, residual);
    field.energy = field_energy(problem, state, residual);
    field.angle = std::move(state.angle);
    field.period_jump = std::move(state.period_jump);
    return field;
}

}  // namespace kinequad
