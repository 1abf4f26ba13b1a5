#include "kinequad/field/period_search.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>

#include "kinequad/core/index.h"

namespace kinequad {
namespace {

using std::numbers::pi;
constexpr int largest_search_rounds = 60;
/// Single steps in a row that kept less than they promised, after which the search ends.
constexpr int largest_failures = 8;
/// Share of one period step's energy that no re-solving of the angles takes back, by measurement.
constexpr double step_share = 1.0 / 3;
/// Improvements below this are rounding.
constexpr double least_gain = 1e-9;

struct Step {
    int edge = 0;
    int change = 0;
    double gain = 0;
};

double step_gain(const FieldProblem& problem, const SingularityPrice& price,
                 const SolvedField& field, int edge, int change) {
    const bool rigid =
        problem.fixed[at(problem.left[at(edge)])] && problem.fixed[at(problem.right[at(edge)])];
    const int a = problem.tail[at(edge)];
    const int b = problem.head[at(edge)];
    const double energy =
        pi * pi / 4 * (rigid ? 1 : step_share) + pi * change * field.residual[edge];
    return energy + price.change(field.index, field.neighbours, a, b, change, price.is_tight(edge));
}

/// Steps that promise to lower the cost, best first, no two of which touch the same vertex.
std::vector<Step> promising_steps(const FieldProblem& problem, const SingularityPrice& price,
                                  const SolvedField& field, const std::vector<bool>& banned) {
    std::vector<Step> steps;
    for (int e = 0; e < problem.edge_count; ++e) {
        if (problem.right[at(e)] < 0 || banned[at(e)]) continue;
        for (const int change : {-1, 1}) {
            const double gain = step_gain(problem, price, field, e, change);
            if (gain < -least_gain) steps.push_back({e, change, gain});
        }
    }
    std::sort(steps.begin(), steps.end(), [](const Step& x, const Step& y) {
        return x.gain != y.gain ? x.gain < y.gain : x.edge < y.edge;
    });
    std::vector<bool> touched(at(problem.vertex_count), false);
    std::vector<Step> independent;
    for (const Step& step : steps) {
        const std::size_t a = at(problem.tail[at(step.edge)]);
        const std::size_t b = at(problem.head[at(step.edge)]);
        if (touched[a] || touched[b]) continue;
        touched[a] = touched[b] = true;
        independent.push_back(step);
    }
    return independent;
}

}  // namespace

SingularityPrice::SingularityPrice(const FieldProblem& problem, const Topology& topology,
                                   double singularity_cost, double adjacency_cost,
                                   std::vector<bool> tight, const std::vector<double>& cost_factor)
    : problem_(problem),
      boundary_(at(topology.vertex_count)),
      singularity_cost_(at(topology.vertex_count), singularity_cost),
      adjacency_cost_(adjacency_cost),
      tight_(std::move(tight)) {
    for (int v = 0; v < topology.vertex_count; ++v) {
        boundary_[at(v)] = topology.is_boundary_vertex(v);
        if (!cost_factor.empty() && !boundary_[at(v)])
            singularity_cost_[at(v)] *= cost_factor[at(v)];
    }
}

double SingularityPrice::vertex_price(int vertex, int index) const {
    const bool boundary = boundary_[at(vertex)];
    const int mirror_edges = problem_.mirror_edges_at[at(vertex)];
    // Together with its mirror image a vertex has twice the angle; where the line of symmetry ends
    // on the boundary, half a straight angle is regular.
    const int whole = mirror_edges == 0 ? index : mirror_edges == 1 ? 2 * index - 2 : 2 * index;
    double price = singularity_cost_[at(vertex)] * std::abs(whole);
    price += 2 * adjacency_cost_ * problem_.avoidance[at(vertex)] * std::abs(whole);
    // Several singularities in one place have even less room than two that an edge joins. On the
    // boundary -2 is the tip of a slit, and positive indices run out of angle below.
    const int crowd = boundary ? -1 - index : std::abs(index);
    if (crowd >= 2) price += 2 * (singularity_cost_[at(vertex)] + adjacency_cost_ * (crowd - 1));
    // A map needs a positive angle (4 - index quarters, on the boundary 2 - index) at every vertex;
    // the prices of what has none, or nearly none, outweigh any energy.
    const int angle = (boundary ? 2 : 4) - index;
    if (angle <= 0) price += 1e3 * (1 - angle);
    if (angle == 1 && !boundary) price += 10;
    if (index < -4) price += 10 * (-4 - index);
    return price;
}

Eigen::VectorXi SingularityPrice::singular_neighbours(const Eigen::VectorXi& index) const {
    Eigen::VectorXi count = Eigen::VectorXi::Zero(index.size());
    for (int e = 0; e < problem_.edge_count; ++e) {
        if (!is_tight(e)) continue;
        const int a = problem_.tail[at(e)];
        const int b = problem_.head[at(e)];
        if (index[b] != 0) ++count[a];
        if (index[a] != 0) ++count[b];
    }
    return count;
}

double SingularityPrice::sum(const Eigen::VectorXi& index) const {
    double result = 0;
    for (int v = 0; v < index.size(); ++v) result += vertex_price(v, index[v]);
    for (int e = 0; e < problem_.edge_count; ++e) {
        if (is_tight(e) && index[problem_.tail[at(e)]] != 0 && index[problem_.head[at(e)]] != 0) {
            result += adjacency_cost_;
        }
    }
    return result;
}

double SingularityPrice::change(const Eigen::VectorXi& index, const Eigen::VectorXi& neighbours,
                                int from, int to, int change, bool joined) const {
    const int from_after = index[from] + change;
    const int to_after = index[to] - change;
    const int from_was = index[from] != 0 ? 1 : 0;
    const int to_was = index[to] != 0 ? 1 : 0;
    const int from_is = from_after != 0 ? 1 : 0;
    const int to_is = to_after != 0 ? 1 : 0;
    int pairs = (from_is - from_was) * neighbours[from] + (to_is - to_was) * neighbours[to];
    if (joined) {
        // The edge between the two was counted as if the other end did not change.
        pairs += (from_is - from_was) * (to_is - to_was);
    }
    return vertex_price(from, from_after) - vertex_price(from, index[from]) +
           vertex_price(to, to_after) - vertex_price(to, index[to]) + adjacency_cost_ * pairs;
}

SolvedField solve_field(const FieldProblem& problem, const AngleSolver& solver,
                        const SingularityPrice& price, FieldState state) {
    SolvedField field;
    field.state = solver.solve(problem, std::move(state));
    field.residual = edge_residuals(problem, field.state);
    field.index = singularity_indices(problem, field.residual);
    field.neighbours = price.singular_neighbours(field.index);
    field.energy = field_energy(problem, field.state, field.residual);
    field.cost = field.energy + price.sum(field.index);
    return field;
}

SolvedField improve_periods(const FieldProblem& problem, const AngleSolver& solver,
                            const SingularityPrice& price, SolvedField field,
                            const Context& context) {
    std::vector<bool> banned(at(problem.edge_count), false);
    std::size_t batch = at(problem.edge_count);
    int failures = 0;
    for (int round = 0; round < largest_search_rounds && failures < largest_failures; ++round) {
        context.check_cancelled();
        std::vector<Step> steps = promising_steps(problem, price, field, banned);
        if (steps.empty()) break;
        steps.resize(std::min(steps.size(), batch));
        FieldState state = field.state;
        for (const Step& step : steps) state.period_jump[step.edge] += step.change;
        SolvedField next = solve_field(problem, solver, price, std::move(state));
        if (next.cost < field.cost - least_gain) {
            field = std::move(next);
            batch *= 2;
            failures = 0;
        } else {
            if (steps.size() == 1) {
                banned[at(steps[0].edge)] = true;
                ++failures;
            }
            batch = (steps.size() + 3) / 4;
        }
    }
    return field;
}

}  // namespace kinequad
