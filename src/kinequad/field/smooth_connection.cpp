#include "kinequad/field/smooth_connection.h"

#include <algorithm>

#include "kinequad/core/index.h"
#include "kinequad/solve/sparse_cholesky.h"

namespace kinequad {
namespace {

using Entries = std::vector<Eigen::Triplet<double>>;

/// Vertices whose surroundings may change: those that touch no fixed triangle.
std::vector<bool> free_vertices(const FieldProblem& problem, const Topology& topology) {
    std::vector<bool> free(at(problem.vertex_count), true);
    for (int v = 0; v < problem.vertex_count; ++v) {
        if (topology.vertex_half_edge[at(v)] < 0) free[at(v)] = false;
    }
    for (std::size_t h = 0; h < topology.origin.size(); ++h) {
        if (problem.fixed[h / 3]) free[at(topology.origin[h])] = false;
    }
    return free;
}

/// Half the cotangents on both sides of every edge; no less than a little, as edges that are not
/// Delaunay have negative ones, which would let curvature run uphill.
Eigen::VectorXd edge_weights(const Topology& topology, const IntrinsicMetric& metric) {
    Eigen::VectorXd weight = Eigen::VectorXd::Zero(topology.edge_count);
    for (int t = 0; t < topology.triangle_count; ++t) {
        const auto sides = side_lengths(topology, metric, t);
        const double area = triangle_area(sides);
        for (std::size_t k = 0; k < 3; ++k) {
            const double opposite = sides[(k + 1) % 3] * sides[(k + 1) % 3] +
                                    sides[(k + 2) % 3] * sides[(k + 2) % 3] - sides[k] * sides[k];
            const double smallest = 1e-6 * sides[k] * sides[k];
            weight[topology.edge[3 * at(t) + k]] += opposite / (8 * std::max(area, smallest));
        }
    }
    return weight.cwiseMax(0.01).cwiseMin(100);
}

/// `M (M + length^2 L)^-1` applied to the defects of the free vertices, by lumped areas M and cotan
/// Laplacian L; no curvature flows to or from the others.
Eigen::VectorXd spread_defects(const FieldProblem& problem, const Topology& topology,
                               const IntrinsicMetric& metric, const std::vector<bool>& free,
                               double length) {
    Eigen::VectorXd mass = Eigen::VectorXd::Zero(problem.vertex_count);
    const Eigen::VectorXd areas = triangle_areas(topology, metric);
    for (std::size_t h = 0; h < topology.origin.size(); ++h) {
        mass[topology.origin[h]] += areas[static_cast<Eigen::Index>(h / 3)] / 3;
    }
    const double smallest = 1e-9 * std::max(mass.maxCoeff(), 1e-300);
    mass = mass.cwiseMax(smallest);
    Eigen::VectorXd diagonal = mass;
    const Eigen::VectorXd weight = length * length * edge_weights(topology, metric);
    Entries entries;
    for (int e = 0; e < problem.edge_count; ++e) {
        const int a = problem.tail[at(e)];
        const int b = problem.head[at(e)];
        if (!free[at(a)] || !free[at(b)]) continue;
        diagonal[a] += weight[e];
        diagonal[b] += weight[e];
        entries.emplace_back(std::max(a, b), std::min(a, b), -weight[e]);
    }
    for (int v = 0; v < problem.vertex_count; ++v) entries.emplace_back(v, v, diagonal[v]);
    SparseCholesky<double>::Matrix A(problem.vertex_count, problem.vertex_count);
    A.setFromTriplets(entries.begin(), entries.end());
    const Eigen::VectorXd density = SparseCholesky<double>(A).solve(problem.defect);
    Eigen::VectorXd spread = problem.defect;
    for (int v = 0; v < problem.vertex_count; ++v) {
        if (free[at(v)]) spread[v] = mass[v] * density[v];
    }
    return spread;
}

/// Solves `L eta = right` by the uniform Laplacian with `eta = 0` at vertices that are not free and
/// at one vertex of a component where all are.
Eigen::VectorXd solve_uniform(const FieldProblem& problem, const Topology& topology,
                              std::vector<bool> free, const Eigen::VectorXd& right) {
    std::vector<bool> held(problem.anchored.size(), false);
    for (int pass = 0; pass < 2; ++pass) {
        for (std::size_t h = 0; h < topology.origin.size(); ++h) {
            const std::size_t c = at(problem.component[h / 3]);
            const std::size_t v = at(topology.origin[h]);
            if (held[c]) continue;
            if (pass == 1) free[v] = false;
            held[c] = !free[v];
        }
    }
    Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(problem.vertex_count);
    Entries entries;
    for (int e = 0; e < problem.edge_count; ++e) {
        const int a = problem.tail[at(e)];
        const int b = problem.head[at(e)];
        diagonal[a] += 1;
        diagonal[b] += 1;
        if (free[at(a)] && free[at(b)]) entries.emplace_back(std::max(a, b), std::min(a, b), -1);
    }
    Eigen::VectorXd masked = Eigen::VectorXd::Zero(problem.vertex_count);
    for (int v = 0; v < problem.vertex_count; ++v) {
        entries.emplace_back(v, v, free[at(v)] ? diagonal[v] : 1);
        if (free[at(v)]) masked[v] = right[v];
    }
    SparseCholesky<double>::Matrix L(problem.vertex_count, problem.vertex_count);
    L.setFromTriplets(entries.begin(), entries.end());
    return SparseCholesky<double>(L).solve(masked);
}

}  // namespace

FieldProblem smooth_connection(const FieldProblem& problem, const Topology& topology,
                               const IntrinsicMetric& metric, double length) {
    const std::vector<bool> free = free_vertices(problem, topology);
    const Eigen::VectorXd spread = spread_defects(problem, topology, metric, free, length);
    const Eigen::VectorXd eta = solve_uniform(problem, topology, free, problem.defect - spread);
    FieldProblem smooth = problem;
    for (int e = 0; e < problem.edge_count; ++e) {
        const int a = problem.tail[at(e)];
        const int b = problem.head[at(e)];
        const double change = eta[a] - eta[b];
        // A boundary edge has no kappa to change, and none is asked: both its ends are held at 0.
        if (problem.right[at(e)] >= 0) smooth.kappa[e] += change;
        smooth.defect[a] -= change;
        smooth.defect[b] += change;
    }
    return smooth;
}

}  // namespace kinequad
