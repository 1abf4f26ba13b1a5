// The algebra that the search over periods relies on, by dense matrices.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <Eigen/Dense>
#include <numbers>

#include "field/surfaces.h"
#include "kinequad/field/angle_solver.h"
#include "kinequad/field/period_search.h"

namespace kinequad {
namespace {

using test::Surface;
using test::surface_of;

using std::numbers::pi;

/// `b^T L^+ b` with `b = defect - pi/2 index` and the uniform Laplacian L of the vertices.
double charge_energy(const FieldProblem& problem, const Eigen::VectorXi& index) {
    Eigen::MatrixXd L = Eigen::MatrixXd::Zero(problem.vertex_count, problem.vertex_count);
    for (std::size_t e = 0; e < problem.tail.size(); ++e) {
        const int a = problem.tail[e];
        const int b = problem.head[e];
        L(a, a) += 1;
        L(b, b) += 1;
        L(a, b) -= 1;
        L(b, a) -= 1;
    }
    const Eigen::VectorXd b = problem.defect - pi / 2 * index.cast<double>();
    return b.dot(L.completeOrthogonalDecomposition().solve(b));
}

TEST(PeriodEnergy, WithoutTargetsIsThatOfChargesAtTheSingularities) {
    for (const TriangleMesh& mesh : {test::sphere(2), test::cube(4), test::tetrahedron()}) {
        const Surface surface = surface_of(mesh);
        const FieldProblem problem = make_field_problem(surface.topology, surface.metric, {}, {});
        const AngleSolver solver(problem);
        const SingularityPrice price(problem, surface.topology, 0.2);
        rc::check([&] {
            FieldState state;
            state.angle = Eigen::VectorXd::Zero(problem.triangle_count);
            state.period_jump.resize(problem.edge_count);
            for (int& p : state.period_jump) p = *rc::gen::inRange(-2, 3);
            const SolvedField field = solve_field(problem, solver, price, state);
            const double expected = charge_energy(problem, field.index);
            RC_ASSERT(std::abs(field.energy - expected) < 1e-8 * (1 + expected));
            RC_ASSERT(field.index.sum() == 8);
        });
    }
}

TEST(PeriodEnergy, IsLeastAtTheSolvedAngles) {
    const Surface surface = surface_of(test::torus(10, 6));
    const CrossFieldTargets targets = test::random_targets(surface.topology, 3, 0.5);
    const FieldProblem problem = make_field_problem(surface.topology, surface.metric, targets, {});
    const AngleSolver solver(problem);
    const SingularityPrice price(problem, surface.topology, 0.2);
    FieldState state;
    state.angle = problem.target;
    state.period_jump = nearest_period_jumps(problem, problem.target);
    SolvedField field = solve_field(problem, solver, price, state);
    // Once every target is at its nearest quarter turn, the energy is a quadratic around the
    // solution.
    for (int round = 0; round < 10; ++round) {
        field = solve_field(problem, solver, price, field.state);
    }
    std::mt19937 random(1);
    std::normal_distribution<double> normal(0, 1e-4);
    for (int trial = 0; trial < 20; ++trial) {
        FieldState moved = field.state;
        for (double& angle : moved.angle) angle += normal(random);
        EXPECT_GT(field_energy(problem, moved, edge_residuals(problem, moved)), field.energy);
    }
}

TEST(PeriodEnergy, PriceChangesByWhatTheStepChanges) {
    const Surface surface = surface_of(test::cylinder(8, 5));
    const FieldProblem problem = make_field_problem(surface.topology, surface.metric, {}, {});
    const SingularityPrice price(problem, surface.topology, 0.2, 0.5,
                                 std::vector<bool>(problem.tail.size(), true));
    rc::check([&] {
        Eigen::VectorXi index(problem.vertex_count);
        for (int& i : index) i = *rc::gen::element(0, 0, 0, 1, -1, 2, -2, 3, 4, -5);
        const auto e = *rc::gen::inRange<std::size_t>(0, problem.tail.size());
        const int change = *rc::gen::element(-1, 1);
        Eigen::VectorXi after = index;
        after[problem.tail[e]] += change;
        after[problem.head[e]] -= change;
        const double promised = price.change(index, price.singular_neighbours(index),
                                             problem.tail[e], problem.head[e], change, true);
        RC_ASSERT(std::abs(price.sum(after) - price.sum(index) - promised) < 1e-9);
    });
}

TEST(PeriodEnergy, CancellationAndSearchOnlyLowerTheCost) {
    for (unsigned seed = 0; seed < 5; ++seed) {
        const Surface surface = surface_of(test::sphere(3));
        const CrossFieldTargets targets = test::random_targets(surface.topology, seed, 0.5);
        const FieldProblem problem =
            make_field_problem(surface.topology, surface.metric, targets, {});
        const AngleSolver solver(problem);
        const SingularityPrice price(problem, surface.topology, 0.2, 0.5,
                                     std::vector<bool>(problem.tail.size(), true));
        FieldState state;
        state.angle = problem.target;
        state.period_jump = nearest_period_jumps(problem, problem.target);
        const SolvedField start = solve_field(problem, solver, price, state);
        const SolvedField improved = improve_periods(problem, solver, price, start, {});
        const SolvedField cancelled = cancel_pairs(problem, solver, price, improved, {});
        EXPECT_LT(improved.cost, start.cost);
        EXPECT_LE(cancelled.cost, improved.cost);
        EXPECT_EQ(cancelled.index.sum(), 8);
    }
}

}  // namespace
}  // namespace kinequad
