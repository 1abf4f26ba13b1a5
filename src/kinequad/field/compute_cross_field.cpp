#include "kinequad/field/compute_cross_field.h"

#include <numbers>
#include <utility>

#include "kinequad/core/index.h"
#include "kinequad/field/convex_field.h"
#include "kinequad/field/period_search.h"
#include "kinequad/field/round_greedily.h"
#include "kinequad/field/smooth_connection.h"

namespace kinequad {
namespace {

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

/// Edges too short to be a few quad edges of the wanted length.
std::vector<bool> short_edges(const IntrinsicMetric& metric, double edge_length) {
    std::vector<bool> result(static_cast<std::size_t>(metric.edge_length.size()));
    for (std::size_t e = 0; e < result.size(); ++e) {
        result[e] = metric.edge_length[static_cast<Eigen::Index>(e)] < 2 * edge_length;
    }
    return result;
}

/// Re-solves until no soft target is nearer at another quarter turn.
FieldState settle_targets(const FieldProblem& problem, const AngleSolver& solver,
                          const SingularityPrice& price, SolvedField field) {
    constexpr int largest_rounds = 20;
    for (int round = 0; round < largest_rounds; ++round) {
        SolvedField next = solve_field(problem, solver, price, field.state);
        if (!(next.energy < field.energy * (1 - 1e-12))) break;
        field = std::move(next);
    }
    return std::move(field.state);
}

FieldState search_field(const FieldProblem& problem, const Topology& topology,
                        const IntrinsicMetric& metric, const CrossFieldOptions& options,
                        const Context& context) {
    const AngleSolver final_solver(problem);
    const SingularityPrice price(problem, topology, options.singularity_cost,
                                 options.adjacency_cost, short_edges(metric, options.edge_length),
                                 options.cost_factor);
    const auto search = [&](const FieldProblem& form, const AngleSolver& solver, FieldState state) {
        SolvedField field = solve_field(form, solver, price, std::move(state));
        field = improve_periods(form, solver, price, std::move(field), context);
        field = cancel_pairs(form, solver, price, std::move(field), context);
        field = improve_periods(form, solver, price, std::move(field), context);
        return settle_targets(form, solver, price, std::move(field));
    };
    const auto start = [&](FieldProblem form) {
        FieldState state;
        state.angle = solve_convex_field(form, context);
        state.period_jump = nearest_period_jumps(form, state.angle);
        if (!(form.symmetry.weight > 0)) return search(form, final_solver, std::move(state));
        // Under the symmetry term singularities go in fours or not at all: at first they go without
        // it, and pair up again under it later.
        form.symmetry.weight = 0;
        return search(form, AngleSolver(form), std::move(state));
    };
    const bool is_smoothed = options.edge_length > 0;
    FieldState state =
        start(is_smoothed ? smooth_connection(problem, topology, metric, options.edge_length / 2)
                          : problem);
    if (!is_smoothed && !(problem.symmetry.weight > 0)) return state;
    return search(problem, final_solver, std::move(state));
}

FieldState round_field(const FieldProblem& problem, const Topology& topology,
                       const Context& context) {
    const AngleSolver solver(problem);
    // Without a price singularities stay where rounding puts them, but for those that admit no map.
    const SingularityPrice price(problem, topology, 0);
    SolvedField field = solve_field(problem, solver, price, round_greedily(problem, context));
    if (price.sum(field.index) > 0) {
        field = improve_periods(problem, solver, price, std::move(field), context);
    }
    return settle_targets(problem, solver, price, std::move(field));
}

}  // namespace

CrossField compute_cross_field(const Topology& topology, const IntrinsicMetric& metric,
                               const CrossFieldTargets& targets, const CrossFieldOptions& options,
                               const Context& context) {
    const FieldProblem problem = make_field_problem(topology, metric, targets, options);
    context.check_cancelled();
    const bool greedy = options.method == CrossFieldMethod::paper;
    FieldState state =
        canonical(problem, greedy ? round_field(problem, topology, context)
                                  : search_field(problem, topology, metric, options, context));

    const Eigen::VectorXd residual = edge_residuals(problem, state);
    CrossField field;
    field.index = singularity_indices(problem, residual);
    field.energy = field_energy(problem, state, residual);
    field.angle = std::move(state.angle);
    field.period_jump = std::move(state.period_jump);
    return field;
}

}  // namespace kinequad
