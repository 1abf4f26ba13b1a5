#include "kinequad/field/convex_field.h"

#include <algorithm>
#include <cmath>

#include "kinequad/core/index.h"
#include "kinequad/solve/sparse_cholesky.h"

namespace kinequad {
namespace {

/// Inverse iteration gains little after these rounds: only the direction of z is used.
constexpr int inverse_iterations = 5;
/// Keeps the matrix definite where a field without any curvature fits exactly.
constexpr double shift = 1e-9;

struct System {
    Eigen::SparseMatrix<Complex> matrix;
    Eigen::VectorXcd right;
};

System assemble(const FieldProblem& problem) {
    const Eigen::Index size = problem.triangle_count;
    System system{Eigen::SparseMatrix<Complex>(size, size), Eigen::VectorXcd::Zero(size)};
    Eigen::VectorXd diagonal = Eigen::VectorXd::Constant(size, shift);
    std::vector<Eigen::Triplet<Complex>> entries;
    entries.reserve(at(problem.edge_count) + at(problem.triangle_count));
    const auto given = [&](int t) { return std::polar(1.0, 4 * problem.fixed_angle[t]); };
    for (int e = 0; e < problem.edge_count; ++e) {
        const int j = problem.right[at(e)];
        if (j < 0) continue;
        const int i = problem.left[at(e)];
        const Complex carry = std::polar(1.0, 4 * problem.kappa[e]);
        diagonal[i] += 1;
        diagonal[j] += 1;
        if (!problem.fixed[at(i)] && !problem.fixed[at(j)]) {
            if (i > j) {
                entries.emplace_back(i, j, -std::conj(carry));
            } else {
                entries.emplace_back(j, i, -carry);
            }
        } else if (!problem.fixed[at(j)]) {
            system.right[j] += carry * given(i);
        } else if (!problem.fixed[at(i)]) {
            system.right[i] += std::conj(carry) * given(j);
        }
    }
    for (int t = 0; t < problem.triangle_count; ++t) {
        if (problem.fixed[at(t)]) {
            diagonal[t] = 1;
            system.right[t] = given(t);
        } else if (problem.weight[t] > 0) {
            diagonal[t] += problem.weight[t];
            system.right[t] += problem.weight[t] * std::polar(1.0, 4 * problem.target[t]);
        }
        entries.emplace_back(t, t, diagonal[t]);
    }
    system.matrix.setFromTriplets(entries.begin(), entries.end());
    return system;
}

}  // namespace

Eigen::VectorXd solve_convex_field(const FieldProblem& problem, const Context& context) {
    System system = assemble(problem);
    const SparseCholesky<Complex> factor(system.matrix);
    context.check_cancelled();
    std::vector<bool> open(at(problem.triangle_count));
    bool any_open = false;
    for (int t = 0; t < problem.triangle_count; ++t) {
        open[at(t)] = !problem.anchored[at(problem.component[at(t)])];
        if (open[at(t)]) system.right[t] = 1;
        any_open = any_open || open[at(t)];
    }
    Eigen::VectorXcd z = factor.solve(system.right);
    for (int round = 1; any_open && round < inverse_iterations; ++round) {
        std::vector<double> largest(problem.anchored.size(), 0);
        for (int t = 0; t < problem.triangle_count; ++t) {
            double& value = largest[at(problem.component[at(t)])];
            value = std::max(value, std::abs(z[t]));
        }
        for (int t = 0; t < problem.triangle_count; ++t) {
            if (open[at(t)]) system.right[t] = z[t] / largest[at(problem.component[at(t)])];
        }
        z = factor.solve(system.right);
    }
    Eigen::VectorXd angle(problem.triangle_count);
    for (int t = 0; t < problem.triangle_count; ++t) {
        angle[t] = problem.fixed[at(t)] ? problem.fixed_angle[t] : std::arg(z[t]) / 4;
    }
    return angle;
}

}  // namespace kinequad
