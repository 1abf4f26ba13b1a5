#include "kinequad/field/angle_solver.h"

#include <algorithm>
#include <numbers>

#include "kinequad/core/index.h"

namespace kinequad {
namespace {

/// Rows of the system: all triangles but the fixed ones and, in components where nothing is asked,
/// the first, which holds the gauge.
std::vector<int> number_unknowns(const FieldProblem& problem) {
    std::vector<int> unknown(at(problem.triangle_count), -1);
    std::vector<bool> held = problem.anchored;
    int count = 0;
    for (int t = 0; t < problem.triangle_count; ++t) {
        const std::size_t c = at(problem.component[at(t)]);
        if (!held[c]) {
            held[c] = true;
        } else if (!problem.fixed[at(t)]) {
            unknown[at(t)] = count++;
        }
    }
    return unknown;
}

Eigen::SparseMatrix<double> assemble(const FieldProblem& problem, const std::vector<int>& unknown,
                                     Eigen::Index size) {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(3 * at(problem.edge_count) + at(problem.triangle_count));
    for (int t = 0; t < problem.triangle_count; ++t) {
        const int i = unknown[at(t)];
        if (i >= 0) entries.emplace_back(i, i, problem.weight[t]);
    }
    for (int e = 0; e < problem.edge_count; ++e) {
        if (problem.right[at(e)] < 0) continue;
        const int i = unknown[at(problem.left[at(e)])];
        const int j = unknown[at(problem.right[at(e)])];
        if (i >= 0) entries.emplace_back(i, i, 1);
        if (j >= 0) entries.emplace_back(j, j, 1);
        if (i >= 0 && j >= 0) entries.emplace_back(std::max(i, j), std::min(i, j), -1);
    }
    const SymmetryTerm& symmetry = problem.symmetry;
    for (int t = 0; symmetry.weight > 0 && t < problem.triangle_count; ++t) {
        const int image = symmetry.image[at(t)];
        if (image < 0) continue;
        const int i = unknown[at(t)];
        const int j = unknown[at(image)];
        if (i >= 0) entries.emplace_back(i, i, symmetry.weight);
        if (j >= 0) entries.emplace_back(j, j, symmetry.weight);
        if (i < 0 || j < 0) continue;
        // A triangle that is its own image counts both ways.
        entries.emplace_back(std::max(i, j), std::min(i, j),
                             i == j ? 2 * symmetry.weight : symmetry.weight);
    }
    Eigen::SparseMatrix<double> A(size, size);
    A.setFromTriplets(entries.begin(), entries.end());
    return A;
}

Eigen::Index count_unknowns(const std::vector<int>& unknown) {
    return std::count_if(unknown.begin(), unknown.end(), [](int i) { return i >= 0; });
}

}  // namespace

AngleSolver::AngleSolver(const FieldProblem& problem)
    : unknown_(number_unknowns(problem)),
      factor_(assemble(problem, unknown_, count_unknowns(unknown_))) {
    for (int t = 0; t < problem.triangle_count; ++t) {
        if (unknown_[at(t)] >= 0) triangle_.push_back(t);
    }
}

Eigen::VectorXd AngleSolver::apply_inverse(const Eigen::VectorXd& r) const {
    Eigen::VectorXd right(static_cast<Eigen::Index>(triangle_.size()));
    for (std::size_t i = 0; i < triangle_.size(); ++i) {
        right[static_cast<Eigen::Index>(i)] = r[triangle_[i]];
    }
    const Eigen::VectorXd solution = factor_.solve(right);
    Eigen::VectorXd result = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(unknown_.size()));
    for (std::size_t i = 0; i < triangle_.size(); ++i) {
        result[triangle_[i]] = solution[static_cast<Eigen::Index>(i)];
    }
    return result;
}

FieldState AngleSolver::solve(const FieldProblem& problem, FieldState state) const {
    // Solving for the change rather than the angles keeps what is given and needs no second matrix.
    Eigen::VectorXd downhill = Eigen::VectorXd::Zero(problem.triangle_count);
    const Eigen::VectorXd residual = edge_residuals(problem, state);
    for (int e = 0; e < problem.edge_count; ++e) {
        if (problem.right[at(e)] < 0) continue;
        downhill[problem.left[at(e)]] -= residual[e];
        downhill[problem.right[at(e)]] += residual[e];
    }
    for (int t = 0; t < problem.triangle_count; ++t) {
        if (!(problem.weight[t] > 0)) continue;
        const double difference = state.angle[t] - problem.target[t];
        downhill[t] -= problem.weight[t] * (difference - quarter * nearest_quarter(difference));
    }
    for (int t = 0; problem.symmetry.weight > 0 && t < problem.triangle_count; ++t) {
        const int image = problem.symmetry.image[at(t)];
        if (image < 0) continue;
        const double push = problem.symmetry.weight * symmetry_residual(problem, state.angle, t);
        downhill[t] -= push;
        downhill[image] -= push;
    }
    state.angle += apply_inverse(downhill);
    return state;
}

}  // namespace kinequad
