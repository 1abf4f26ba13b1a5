#include "kinequad/field/smooth_connection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "field/surfaces.h"

namespace kinequad {
namespace {

using test::Surface;
using test::surface_of;

TEST(SmoothConnection, KeepsTheHolonomyOfEveryState) {
    // kappa and defect change together, so that the same angles and periods have the same indices,
    // even exactly.
    for (const Surface& surface : test::all_surfaces()) {
        const FieldProblem problem = make_field_problem(surface.topology, surface.metric, {}, {});
        const FieldProblem smooth =
            smooth_connection(problem, surface.topology, surface.metric, 0.4);
        FieldState state;
        state.angle = Eigen::VectorXd::LinSpaced(problem.triangle_count, 0, 1);
        for (int t = 0; t < problem.triangle_count; ++t) {
            if (problem.fixed[static_cast<std::size_t>(t)]) state.angle[t] = problem.fixed_angle[t];
        }
        state.period_jump = nearest_period_jumps(problem, state.angle);
        EXPECT_EQ(singularity_indices(problem, edge_residuals(problem, state)),
                  singularity_indices(smooth, edge_residuals(smooth, state)))
            << surface.name;
        EXPECT_NEAR(smooth.defect.sum(), problem.defect.sum(), 1e-9) << surface.name;
    }
}

TEST(SmoothConnection, SpreadsTheCornersOfACube) {
    const Surface cube = surface_of(test::cube(8));
    const FieldProblem problem = make_field_problem(cube.topology, cube.metric, {}, {});
    double last = problem.defect.maxCoeff();
    EXPECT_NEAR(last, std::numbers::pi / 2, 1e-12);
    for (const double length : {0.1, 0.3, 1.0, 3.0}) {
        const FieldProblem smooth = smooth_connection(problem, cube.topology, cube.metric, length);
        EXPECT_LT(smooth.defect.maxCoeff(), last);
        EXPECT_GT(smooth.defect.minCoeff(), -1e-9);
        last = smooth.defect.maxCoeff();
    }
    // In the end every vertex has its share of 4 pi by area.
    const FieldProblem even = smooth_connection(problem, cube.topology, cube.metric, 1e3);
    EXPECT_LT(even.defect.maxCoeff(), 2 * 4 * std::numbers::pi / problem.vertex_count);
}

TEST(SmoothConnection, LeavesTheConnectionAlongTheBoundary) {
    const Surface cylinder = surface_of(test::cylinder(12, 8));
    FieldProblem problem = make_field_problem(cylinder.topology, cylinder.metric, {}, {});
    // A bump in the middle, made by hand: curvature without a surface.
    problem.defect[50] += 1;
    problem.defect[53] -= 1;
    const FieldProblem smooth = smooth_connection(problem, cylinder.topology, cylinder.metric, 0.3);
    EXPECT_LT(smooth.defect[50], 0.7);
    for (std::size_t e = 0; e < problem.left.size(); ++e) {
        const auto fixed = [&](int t) {
            return t < 0 || problem.fixed[static_cast<std::size_t>(t)];
        };
        if (fixed(problem.left[e]) && fixed(problem.right[e])) {
            EXPECT_EQ(smooth.kappa[static_cast<Eigen::Index>(e)],
                      problem.kappa[static_cast<Eigen::Index>(e)]);
        }
    }
    for (int v = 0; v < 12; ++v) EXPECT_NEAR(smooth.defect[v], problem.defect[v], 1e-9);
}

}  // namespace
}  // namespace kinequad
