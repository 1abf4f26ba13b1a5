#include "kinequad/field/field_problem.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/field/even_turns.h"
#include "kinequad/mesh/edge_distances.h"

namespace kinequad {
namespace {

/// Directions of all half-edges (3m) in the frames of their triangles.
std::vector<double> all_directions(const Topology& topology, const IntrinsicMetric& metric) {
    std::vector<double> directions;
    directions.reserve(3 * at(topology.triangle_count));
    for (int t = 0; t < topology.triangle_count; ++t) {
        for (const double d : half_edge_directions(side_lengths(topology, metric, t))) {
            directions.push_back(d);
        }
    }
    return directions;
}

void check_options(const Topology& topology, const CrossFieldTargets& targets,
                   const CrossFieldOptions& options) {
    for (const int e : options.feature_edges) {
        if (e < 0 || e >= topology.edge_count) {
            throw InputError(InputFault::usage,
                             fmt::format("feature edge {} does not exist; the mesh has {} edges", e,
                                         topology.edge_count));
        }
    }
    for (const int e : options.mirror_edges) {
        if (e < 0 || e >= topology.edge_count || !topology.is_boundary_edge(e)) {
            throw InputError(InputFault::usage,
                             fmt::format("mirror edge {} is no boundary edge of the mesh", e));
        }
    }
    for (const int v : options.avoided_vertices) {
        if (v < 0 || v >= topology.vertex_count) {
            throw InputError(InputFault::usage, fmt::format("avoided vertex {} does not exist", v));
        }
    }
    for (const FixedDirection& fixed : options.fixed_directions) {
        if (fixed.triangle < 0 || fixed.triangle >= topology.triangle_count ||
            !std::isfinite(fixed.angle)) {
            throw InputError(InputFault::usage,
                             fmt::format("fixed direction {} of triangle {}: name one of the {} "
                                         "triangles and a finite angle",
                                         fixed.angle, fixed.triangle, topology.triangle_count));
        }
    }
    require(options.cost_factor.empty() || options.cost_factor.size() == at(topology.vertex_count),
            InputFault::usage, "cost factors of singularities need one number a vertex");
    require(targets.value.size() == targets.weight.size() &&
                (targets.value.size() == 0 || targets.value.size() == topology.triangle_count),
            InputFault::usage, "cross field targets need one value and one weight a triangle");
}

/// A triangle with several edges to align with takes the mean cross of them, weighted by length, so
/// that no edge is left further off than it has to be.
void fix_crosses(FieldProblem& problem, const Topology& topology, const IntrinsicMetric& metric,
                 const CrossFieldOptions& options, const std::vector<double>& directions) {
    const std::size_t count = at(problem.triangle_count);
    std::vector<Complex> sum(count, 0);
    std::vector<double> longest(count, 0);
    std::vector<double> longest_direction(count, 0);
    const auto align = [&](int half_edge, double length, double turned_by) {
        const std::size_t t = at(half_edge / 3);
        const double direction = directions[at(half_edge)] + turned_by;
        problem.fixed[t] = true;
        sum[t] += std::polar(length, 4 * direction);
        if (length > longest[t]) {
            longest[t] = length;
            longest_direction[t] = direction;
        }
    };
    std::vector<bool> feature(at(topology.edge_count), false);
    for (const int e : options.feature_edges) feature[at(e)] = true;
    const std::vector<double> turned = even_turns(topology, metric, options);
    for (int e = 0; e < topology.edge_count; ++e) {
        if (!feature[at(e)] && !topology.is_boundary_edge(e)) continue;
        const int h = topology.edge_half_edge[at(e)];
        align(h, metric.edge_length[e], turned[at(e)]);
        if (topology.twin[at(h)] >= 0) align(topology.twin[at(h)], metric.edge_length[e], 0);
    }
    std::vector<bool> by_edge = problem.fixed;
    for (std::size_t t = 0; t < count; ++t) {
        if (!by_edge[t]) continue;
        const bool clear = std::abs(sum[t]) > 1e-6 * longest[t];
        problem.fixed_angle[static_cast<Eigen::Index>(t)] =
            clear ? std::arg(sum[t]) / 4 : longest_direction[t];
    }
    for (const FixedDirection& direction : options.fixed_directions) {
        if (by_edge[at(direction.triangle)]) continue;
        problem.fixed[at(direction.triangle)] = true;
        problem.fixed_angle[direction.triangle] = direction.angle;
    }
}

/// 1 at the vertices to avoid and on mirror edges, falling to 0 within one quad edge: between a
/// line of the quad mesh and a singularity beside it there have to be quads.
std::vector<double> measure_avoidance(const Topology& topology, const IntrinsicMetric& metric,
                                      const CrossFieldOptions& options) {
    const double range = options.edge_length;
    std::vector<int> sources = options.avoided_vertices;
    for (const int e : options.mirror_edges) {
        const int h = topology.edge_half_edge[at(e)];
        sources.push_back(topology.origin[at(h)]);
        sources.push_back(topology.target(h));
    }
    const std::vector<double> distance = edge_distances(topology, metric, sources, range);
    std::vector<double> avoidance(distance.size(), 0);
    for (std::size_t v = 0; v < distance.size(); ++v) {
        if (distance[v] == 0) {
            avoidance[v] = 1;
        } else if (distance[v] < range) {
            avoidance[v] = 1 - distance[v] / range;
        }
    }
    return avoidance;
}

void find_anchors(FieldProblem& problem) {
    int components = 0;
    for (const int c : problem.component) components = std::max(components, c + 1);
    std::vector<double> soft(at(components), 0);
    problem.anchored.assign(at(components), false);
    for (int t = 0; t < problem.triangle_count; ++t) {
        const std::size_t c = at(problem.component[at(t)]);
        soft[c] += problem.weight[t];
        if (problem.fixed[at(t)]) problem.anchored[c] = true;
    }
    // Below this the soft terms only make the systems singular to working precision.
    constexpr double weakest = 1e-7;
    for (std::size_t c = 0; c < soft.size(); ++c) {
        if (soft[c] > weakest) problem.anchored[c] = true;
    }
    for (int t = 0; t < problem.triangle_count; ++t) {
        if (!problem.anchored[at(problem.component[at(t)])]) problem.weight[t] = 0;
    }
}

}  // namespace

int nearest_quarter(double angle) { return static_cast<int>(std::lround(angle / quarter)); }

FieldProblem make_field_problem(const Topology& topology, const IntrinsicMetric& metric,
                                const CrossFieldTargets& targets,
                                const CrossFieldOptions& options) {
    check_options(topology, targets, options);
    FieldProblem problem;
    problem.triangle_count = topology.triangle_count;
    problem.edge_count = topology.edge_count;
    problem.vertex_count = topology.vertex_count;
    problem.defect = angle_defects(topology, metric);
    problem.weight = Eigen::VectorXd::Zero(topology.triangle_count);
    problem.target = Eigen::VectorXd::Zero(topology.triangle_count);
    problem.fixed.assign(at(topology.triangle_count), false);
    problem.fixed_angle = Eigen::VectorXd::Zero(topology.triangle_count);
    problem.component = triangle_components(topology);

    const std::vector<double> directions = all_directions(topology, metric);
    fix_crosses(problem, topology, metric, options, directions);
    problem.avoidance = measure_avoidance(topology, metric, options);
    problem.mirror_edges_at.assign(at(topology.vertex_count), 0);
    for (const int e : options.mirror_edges) {
        const int h = topology.edge_half_edge[at(e)];
        ++problem.mirror_edges_at[at(topology.origin[at(h)])];
        ++problem.mirror_edges_at[at(topology.target(h))];
    }
    if (targets.value.size() > 0) {
        for (int t = 0; t < topology.triangle_count; ++t) {
            if (problem.fixed[at(t)]) continue;
            problem.weight[t] = targets.weight[t];
            problem.target[t] = std::arg(targets.value[t]) / 4;
        }
    }
    find_anchors(problem);
    problem.symmetry = options.symmetry;

    problem.kappa = Eigen::VectorXd::Zero(topology.edge_count);
    problem.boundary_residual = Eigen::VectorXd::Zero(topology.edge_count);
    for (int e = 0; e < topology.edge_count; ++e) {
        const int h = topology.edge_half_edge[at(e)];
        const int other = topology.twin[at(h)];
        problem.left.push_back(h / 3);
        problem.right.push_back(other < 0 ? -1 : other / 3);
        problem.tail.push_back(topology.origin[at(h)]);
        problem.head.push_back(topology.target(h));
        if (other >= 0) {
            problem.kappa[e] = directions[at(other)] + std::numbers::pi - directions[at(h)];
        } else {
            const double difference = problem.fixed_angle[h / 3] - directions[at(h)];
            problem.boundary_residual[e] = difference - quarter * nearest_quarter(difference);
        }
    }
    return problem;
}

Eigen::VectorXd edge_residuals(const FieldProblem& problem, const FieldState& state) {
    Eigen::VectorXd residual = problem.boundary_residual;
    for (int e = 0; e < problem.edge_count; ++e) {
        if (problem.right[at(e)] < 0) continue;
        residual[e] = state.angle[problem.left[at(e)]] + problem.kappa[e] +
                      quarter * state.period_jump[e] - state.angle[problem.right[at(e)]];
    }
    return residual;
}

Eigen::VectorXi singularity_indices(const FieldProblem& problem, const Eigen::VectorXd& residual) {
    Eigen::VectorXd holonomy = problem.defect;
    for (int e = 0; e < problem.edge_count; ++e) {
        holonomy[problem.tail[at(e)]] += residual[e];
        holonomy[problem.head[at(e)]] -= residual[e];
    }
    Eigen::VectorXi index(problem.vertex_count);
    for (int v = 0; v < problem.vertex_count; ++v) index[v] = nearest_quarter(holonomy[v]);
    return index;
}

double symmetry_residual(const FieldProblem& problem, const Eigen::VectorXd& angle, int t) {
    const double sum =
        angle[problem.symmetry.image[at(t)]] + angle[t] - problem.symmetry.transport[t];
    return sum - quarter * nearest_quarter(sum);
}

double field_energy(const FieldProblem& problem, const FieldState& state,
                    const Eigen::VectorXd& residual) {
    double energy = 0;
    for (int e = 0; e < problem.edge_count; ++e) {
        if (problem.right[at(e)] >= 0) energy += residual[e] * residual[e];
    }
    for (int t = 0; t < problem.triangle_count; ++t) {
        if (!(problem.weight[t] > 0)) continue;
        const double difference = state.angle[t] - problem.target[t];
        const double snapped = difference - quarter * nearest_quarter(difference);
        energy += problem.weight[t] * snapped * snapped;
    }
    for (int t = 0; problem.symmetry.weight > 0 && t < problem.triangle_count; ++t) {
        if (problem.symmetry.image[at(t)] < 0) continue;
        const double difference = symmetry_residual(problem, state.angle, t);
        energy += problem.symmetry.weight * difference * difference;
    }
    return energy;
}

Eigen::VectorXi nearest_period_jumps(const FieldProblem& problem, const Eigen::VectorXd& angle) {
    Eigen::VectorXi period_jump = Eigen::VectorXi::Zero(problem.edge_count);
    for (int e = 0; e < problem.edge_count; ++e) {
        if (problem.right[at(e)] < 0) continue;
        period_jump[e] = -nearest_quarter(angle[problem.left[at(e)]] + problem.kappa[e] -
                                          angle[problem.right[at(e)]]);
    }
    return period_jump;
}

}  // namespace kinequad
