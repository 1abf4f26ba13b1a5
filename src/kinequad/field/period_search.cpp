#include "kinequad/field/period_search.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace kinequad {
namespace {

constexpr double pi = std::numbers::pi;
constexpr int largest_rounds = 60;
/// Share of one period step's energy that no re-solving of the angles takes back, by measurement.
constexpr double step_share = 1.0 / 3;
/// Improvements below this are rounding.
constexpr double least_gain = 1e-9;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

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
    return energy + price(a, field.index[a] + change) - price(a, field.index[a]) +
           price(b, field.index[b] - change) - price(b, field.index[b]);
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

SingularityPrice::SingularityPrice(const Topology& topology, double singularity_cost)
    : boundary_(at(topology.vertex_count)), cost_(singularity_cost) {
    for (int v = 0; v < topology.vertex_count; ++v) {
        boundary_[at(v)] = topology.is_boundary_vertex(v);
    }
}

double SingularityPrice::operator()(int vertex, int index) const {
    // A map needs a positive angle (4 - index quarters, on the boundary 2 - index) at every vertex;
    // the prices of what has none, or nearly none, outweigh any energy.
    const int angle = (boundary_[at(vertex)] ? 2 : 4) - index;
    double price = cost_ * std::abs(index);
    if (angle <= 0) price += 1e3 * (1 - angle);
    if (angle == 1 && !boundary_[at(vertex)]) price += 10;
    if (index < -4) price += 10 * (-4 - index);
    return price;
}

double SingularityPrice::sum(const Eigen::VectorXi& index) const {
    double result = 0;
    for (int v = 0; v < index.size(); ++v) {
        if (index[v] != 0) result += (*this)(v, index[v]);
    }
    return result;
}

SolvedField solve_field(const FieldProblem& problem, const AngleSolver& solver,
                        const SingularityPrice& price, FieldState state) {
    SolvedField field;
    field.state = solver.solve(problem, std::move(state));
    field.residual = edge_residuals(problem, field.state);
    field.index = singularity_indices(problem, field.residual);
    field.energy = field_energy(problem, field.state, field.residual);
    field.cost = field.energy + price.sum(field.index);
    return field;
}

SolvedField improve_periods(const FieldProblem& problem, const AngleSolver& solver,
                            const SingularityPrice& price, SolvedField field,
                            const Context& context) {
    std::vector<bool> banned(at(problem.edge_count), false);
    for (int round = 0; round < largest_rounds; ++round) {
        context.check_cancelled();
        std::vector<Step> steps = promising_steps(problem, price, field, banned);
        bool improved = false;
        while (!steps.empty() && !improved) {
            FieldState state = field.state;
            for (const Step& step : steps) state.period_jump[step.edge] += step.change;
            SolvedField next = solve_field(problem, solver, price, std::move(state));
            if (next.cost < field.cost - least_gain) {
                field = std::move(next);
                improved = true;
            } else if (steps.size() == 1) {
                banned[at(steps[0].edge)] = true;
                break;
            } else {
                steps.resize((steps.size() + 3) / 4);
            }
        }
        if (steps.empty()) break;
    }
    return field;
}

}  // namespace kinequad
