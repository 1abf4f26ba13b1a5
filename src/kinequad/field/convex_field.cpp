#include "kinequad/field/convex_field.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

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

/// The system over real and imaginary parts, 2t and 2t + 1 of triangle t: the mirror image of a
/// cross is a conjugate, which is linear over the reals alone.
Eigen::SparseMatrix<double> add_symmetry(const FieldProblem& problem, System& system) {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(at(4 * static_cast<int>(system.matrix.nonZeros())) +
                    6 * at(problem.triangle_count));
    const auto add_block = [&](int i, int j, const Eigen::Matrix2d& block) {
        if (i < j) return;
        for (int r = 0; r < 2; ++r) {
            for (int c = 0; c < (i == j ? r + 1 : 2); ++c) {
                entries.emplace_back(2 * i + r, 2 * j + c, block(r, c));
            }
        }
    };
    for (int column = 0; column < system.matrix.outerSize(); ++column) {
        for (Eigen::SparseMatrix<Complex>::InnerIterator entry(system.matrix, column); entry;
             ++entry) {
            const Complex value = entry.value();
            Eigen::Matrix2d block;
            block << value.real(), -value.imag(), value.imag(), value.real();
            add_block(static_cast<int>(entry.row()), column, block);
        }
    }
    const double weight = problem.symmetry.weight;
    for (int t = 0; t < problem.triangle_count; ++t) {
        const int image = problem.symmetry.image[at(t)];
        if (image < 0) continue;
        const Complex turn = std::polar(1.0, 4 * problem.symmetry.transport[t]);
        const bool is_given = problem.fixed[at(t)];
        const bool is_image_given = problem.fixed[at(image)];
        const auto carried = [&](int from) {
            return weight * turn * std::conj(std::polar(1.0, 4 * problem.fixed_angle[from]));
        };
        if (!is_given) add_block(t, t, weight * Eigen::Matrix2d::Identity());
        if (!is_image_given) add_block(image, image, weight * Eigen::Matrix2d::Identity());
        Eigen::Matrix2d reflection;
        reflection << turn.real(), turn.imag(), turn.imag(), -turn.real();
        if (!is_given && !is_image_given) {
            add_block(std::max(t, image), std::min(t, image),
                      (t == image ? -2 : -1) * weight * reflection);
        } else if (!is_given) {
            system.right[t] += carried(image);
        } else if (!is_image_given) {
            system.right[image] += carried(t);
        }
    }
    const Eigen::Index size = 2 * static_cast<Eigen::Index>(problem.triangle_count);
    Eigen::SparseMatrix<double> matrix(size, size);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
}

/// A factor of the system with or without the symmetry term.
std::function<Eigen::VectorXcd(const Eigen::VectorXcd&)> factor_system(const FieldProblem& problem,
                                                                       System& system) {
    if (problem.symmetry.weight > 0) {
        const auto factor = std::make_shared<SparseCholesky<double>>(add_symmetry(problem, system));
        return [factor](const Eigen::VectorXcd& right) {
            const auto* parts = reinterpret_cast<const double*>(right.data());
            const Eigen::VectorXd x =
                factor->solve(Eigen::Map<const Eigen::VectorXd>(parts, 2 * right.size()));
            return Eigen::VectorXcd(Eigen::Map<const Eigen::VectorXcd>(
                reinterpret_cast<const Complex*>(x.data()), right.size()));
        };
    }
    const auto factor = std::make_shared<SparseCholesky<Complex>>(system.matrix);
    return [factor](const Eigen::VectorXcd& right) { return factor->solve(right); };
}

}  // namespace

Eigen::VectorXd solve_convex_field(const FieldProblem& problem, const Context& context) {
    System system = assemble(problem);
    const auto solve = factor_system(problem, system);
    context.check_cancelled();
    std::vector<bool> open(at(problem.triangle_count));
    bool any_open = false;
    for (int t = 0; t < problem.triangle_count; ++t) {
        open[at(t)] = !problem.anchored[at(problem.component[at(t)])];
        if (open[at(t)]) system.right[t] = 1;
        any_open = any_open || open[at(t)];
    }
    Eigen::VectorXcd z = solve(system.right);
    for (int round = 1; any_open && round < inverse_iterations; ++round) {
        std::vector<double> largest(problem.anchored.size(), 0);
        for (int t = 0; t < problem.triangle_count; ++t) {
            double& value = largest[at(problem.component[at(t)])];
            value = std::max(value, std::abs(z[t]));
        }
        for (int t = 0; t < problem.triangle_count; ++t) {
            if (open[at(t)]) system.right[t] = z[t] / largest[at(problem.component[at(t)])];
        }
        z = solve(system.right);
    }
    Eigen::VectorXd angle(problem.triangle_count);
    for (int t = 0; t < problem.triangle_count; ++t) {
        angle[t] = problem.fixed[at(t)] ? problem.fixed_angle[t] : std::arg(z[t]) / 4;
    }
    return angle;
}

}  // namespace kinequad
