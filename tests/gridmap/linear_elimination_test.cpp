#include "kinequad/gridmap/linear_elimination.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <random>

namespace kinequad {
namespace {

template <class Number>
using Rows = std::vector<LinearForm<Number>>;

/// `count` rows over `variables` variables with small whole coefficients, some of them zero; the
/// last ones repeat combinations of the first, so that the rank is less than the count.
Rows<long> random_rows(int variables, int count, int dependent, std::mt19937& random) {
    std::uniform_int_distribution<long> coefficient(-3, 3);
    std::uniform_int_distribution<int> is_zero(0, 2);
    Rows<long> rows;
    for (int i = 0; i < count; ++i) {
        LinearForm<long> row;
        for (int v = 0; v < variables; ++v) {
            const long c = is_zero(random) == 0 ? 0 : coefficient(random);
            if (c != 0) row.emplace_back(v, c);
        }
        rows.push_back(row);
    }
    for (int i = 0; i < dependent; ++i) {
        LinearForm<long> sum;
        for (int j = 0; j < count; ++j) {
            const long c = coefficient(random);
            if (c != 0) sum = add_scaled(sum, c, rows[static_cast<std::size_t>(j)]);
        }
        rows.push_back(sum);
    }
    return rows;
}

template <class Number>
Eigen::MatrixXd dense(const Rows<Number>& rows, int columns) {
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows.size()), columns);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        for (const auto& [v, c] : rows[i]) {
            matrix(static_cast<Eigen::Index>(i), v) += static_cast<double>(c);
        }
    }
    return matrix;
}

Eigen::Index rank_of(const Eigen::MatrixXd& matrix) {
    return matrix.size() == 0 ? 0 : Eigen::FullPivLU<Eigen::MatrixXd>(matrix).rank();
}

Rows<double> as_real(const Rows<long>& rows) {
    Rows<double> real;
    for (const auto& row : rows) real.emplace_back(row.begin(), row.end());
    return real;
}

/// Every whole point of the box [-size, size]^variables that solves `rows` is a whole combination
/// of the free variables, found by exact back-substitution of the least-squares coefficients.
void expect_complete(const Rows<long>& rows, int variables, int size,
                     const Elimination<long>& result) {
    const Eigen::MatrixXd conditions = dense(rows, variables);
    const Eigen::MatrixXd basis = dense(result.solution, result.free_count);
    ASSERT_EQ(rank_of(basis), result.free_count) << "the basis has to be independent";
    Eigen::VectorXd point = Eigen::VectorXd::Constant(variables, -size);
    int solutions = 0;
    while (true) {
        if ((conditions * point).isZero(1e-9)) {
            ++solutions;
            Eigen::VectorXd y(result.free_count);
            if (result.free_count > 0) {
                y = basis.colPivHouseholderQr().solve(point).array().round();
            }
            const Eigen::VectorXd back = result.free_count > 0
                                             ? Eigen::VectorXd(basis * y)
                                             : Eigen::VectorXd::Zero(variables).eval();
            ASSERT_LT((back - point).cwiseAbs().maxCoeff(), 1e-9)
                << "not in the lattice: " << point.transpose();
        }
        int digit = 0;
        while (digit < variables && point[digit] == size) point[digit++] = -size;
        if (digit == variables) break;
        ++point[digit];
    }
    EXPECT_GE(solutions, 1);
}

TEST(AddScaled, SortsAndCancels) {
    const LinearForm<long> a = {{0, 1}, {2, 4}, {5, -1}};
    const LinearForm<long> b = {{1, 3}, {2, -2}, {7, 1}};
    const LinearForm<long> expected = {{0, 1}, {1, 6}, {5, -1}, {7, 2}};
    EXPECT_EQ(add_scaled(a, 2L, b), expected);
    EXPECT_TRUE(add_scaled(a, -1L, a).empty());
}

TEST(EliminateIntegers, HalvesKeepTheirParity) {
    // 2a = b + c: b and c are of the same parity, which no choice of two of the three shows.
    const Rows<long> rows = {{{0, 2}, {1, -1}, {2, -1}}};
    const auto result = eliminate_integers(3, rows, {0, 0, 0});
    EXPECT_EQ(result.free_count, 2);
    expect_complete(rows, 3, 4, result);
}

TEST(EliminateIntegers, NeedsNewVariablesWhereNoCoefficientIsOne) {
    const Rows<long> rows = {{{0, 2}, {1, 3}}};
    const auto result = eliminate_integers(2, rows, {0, 0});
    ASSERT_EQ(result.free_count, 1);
    EXPECT_EQ(result.free_variable, std::vector<int>{-1});
    expect_complete(rows, 2, 9, result);
    const Rows<long> harder = {{{0, 6}, {1, 10}, {2, 15}}, {{1, 4}, {2, 6}, {3, -9}}};
    expect_complete(harder, 4, 5, eliminate_integers(4, harder, {0, 0, 0, 0}));
}

TEST(EliminateIntegers, CommonDivisorsDropOut) {
    // 4a = 6b says 2a = 3b, not that a and b are even.
    const Rows<long> rows = {{{0, 4}, {1, -6}}};
    expect_complete(rows, 2, 9, eliminate_integers(2, rows, {0, 0}));
}

TEST(EliminateIntegers, EverySolutionOfTheBoxIsALatticePoint) {
    std::mt19937 random(5);
    for (int run = 0; run < 60; ++run) {
        const int variables = 3 + run % 3;
        const int count = run % 4;
        const Rows<long> rows = random_rows(variables, count, run % 2, random);
        const std::vector<int> priority(static_cast<std::size_t>(variables), run % 3);
        const auto result = eliminate_integers(variables, rows, priority);
        const Eigen::MatrixXd conditions = dense(rows, variables);
        EXPECT_EQ(result.free_count, variables - rank_of(conditions));
        EXPECT_TRUE((conditions * dense(result.solution, result.free_count)).isZero(1e-9));
        expect_complete(rows, variables, 3, result);
    }
}

TEST(EliminateIntegers, ExpressesTheVariablesOfLowestPriority) {
    const Rows<long> rows = {{{0, 1}, {1, 1}, {2, -1}}, {{2, 1}, {3, 1}}};
    const auto result = eliminate_integers(4, rows, {2, 0, 1, 2});
    EXPECT_EQ(result.free_variable, (std::vector<int>{0, 3}));
}

TEST(EliminateReals, SolvesEveryRowAndLosesNoFreedom) {
    std::mt19937 random(11);
    for (int run = 0; run < 100; ++run) {
        const int variables = 4 + run % 9;
        const int count = 1 + run % 8;
        const Rows<long> rows = random_rows(variables, count, run % 4, random);
        std::vector<int> priority;
        for (int v = 0; v < variables; ++v) priority.push_back((v + run) % 3);
        const auto result = eliminate_reals(variables, as_real(rows), priority);
        const Eigen::MatrixXd conditions = dense(rows, variables);
        EXPECT_EQ(result.free_count, variables - rank_of(conditions)) << "run " << run;
        const Eigen::MatrixXd basis = dense(result.solution, result.free_count);
        EXPECT_TRUE((conditions * basis).isZero(1e-6)) << "run " << run;
        EXPECT_EQ(rank_of(basis), result.free_count);
        for (int i = 0; i < result.free_count; ++i) {
            const int v = result.free_variable[static_cast<std::size_t>(i)];
            EXPECT_EQ(result.solution[static_cast<std::size_t>(v)], (LinearForm<double>{{i, 1.0}}));
        }
    }
}

TEST(EliminateReals, SolutionsDoNotDependOnTheirOrderOfUse) {
    // A long chain of equalities, as the translations along a chain of the cut make them.
    constexpr int length = 3000;
    Rows<double> rows;
    for (int i = 0; i + 1 < length; ++i) rows.push_back({{i, 1.0}, {i + 1, -1.0}});
    for (const bool is_reversed : {false, true}) {
        if (is_reversed) std::reverse(rows.begin(), rows.end());
        const auto result = eliminate_reals(length, rows, std::vector<int>(length, 0));
        ASSERT_EQ(result.free_count, 1);
        for (const auto& form : result.solution) {
            ASSERT_EQ(form, (LinearForm<double>{{0, 1.0}}));
        }
    }
}

}  // namespace
}  // namespace kinequad
