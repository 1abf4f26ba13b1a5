#include "kinequad/gridmap/seamless_map.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "gridmap/map_checks.h"

namespace kinequad {
namespace {

SeamlessMap solve(const test::PreparedMap& map) {
    TriangleSystem system(map.variables);
    return solve_seamless_map(map.variables, system, map.shapes, {});
}

TEST(SeamlessMap, FlatShapesAreMappedWithoutDistortion) {
    for (const test::Surface& surface :
         {test::flat_torus(8, 6), test::surface_of(test::square(7), "square"),
          test::surface_of(test::cube(5), "cube"),
          test::surface_of(test::cylinder(20, 9), "cylinder"),
          test::surface_of(test::double_ring(3), "genus 2")}) {
        SCOPED_TRACE(surface.name);
        const CrossField field = test::field_of(surface);
        if (surface.name == "genus 2" && field.energy > 1e-12) continue;
        const test::PreparedMap map = test::prepare(surface, field, 200);
        const SeamlessMap seamless = solve(map);
        EXPECT_EQ(seamless.reversed_triangles, 0);
        const std::vector<Complex> corners = map.variables.corner_coordinates(seamless.x);
        for (int h = 0; h < 3 * map.mesh.triangle_count(); ++h) {
            EXPECT_LT(
                std::abs(test::displacement(corners, h) - test::displacement(map.mesh.target, h)),
                1e-7);
        }
        EXPECT_LT((seamless.integers - seamless.best_integers).norm(), 1e-9);
    }
}

TEST(SeamlessMap, IsInjectiveOnCurvedSurfaces) {
    for (const test::Surface& surface : test::map_surfaces()) {
        SCOPED_TRACE(surface.name);
        const test::PreparedMap map = test::prepare(surface, 300);
        const SeamlessMap seamless = solve(map);
        ASSERT_EQ(seamless.reversed_triangles, 0);
        const std::vector<Complex> corners = map.variables.corner_coordinates(seamless.x);
        test::expect_seamless(map.mesh, &map.cut.is_cut, corners);
        test::expect_injective(map.mesh, corners);
        if (map.variables.integer_count() > 0) {
            EXPECT_LT((map.variables.lattice * seamless.integers -
                       seamless.x.tail(map.variables.chain_columns))
                          .norm(),
                      1e-8);
        }
    }
}

TEST(KeepsDirection, TellsTurnsAndMirrorsFromStretch) {
    const test::PreparedMap map = test::prepare(test::surface_of(test::square(2)), 4);
    const auto keeps = [&](Complex a, Complex b) {
        std::array<Complex, 3> z;
        for (int k = 0; k < 3; ++k) {
            const Complex q = map.mesh.target[at(k)];
            z[at(k)] = a * q + b * std::conj(q);
        }
        return keeps_direction(map.shapes[0], z.data());
    };
    EXPECT_TRUE(keeps(1, 0));
    EXPECT_TRUE(keeps(5, 4.9));
    EXPECT_TRUE(keeps(std::polar(1.0, 1.5), 0));
    EXPECT_FALSE(keeps(std::polar(1.0, 1.6), 0));
    EXPECT_FALSE(keeps(0, 1));
    EXPECT_FALSE(keeps(1, 1.01));
}

/// Least energy over the vertex columns with the integer unknowns at `y`, by dense least squares.
double least_energy(const test::PreparedMap& map, const Eigen::VectorXd& y) {
    const MapVariables& variables = map.variables;
    const int triangles = map.mesh.triangle_count();
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(4 * triangles, variables.columns());
    Eigen::VectorXd wanted = Eigen::VectorXd::Zero(4 * triangles);
    for (int t = 0; t < triangles; ++t) {
        for (int part = 0; part < 4; ++part) {
            // Re a, Im a, Re b, Im b.
            const double share = std::array{1.0, turn_weight, 1.0, shear_weight}[at(part)];
            const double weight = std::sqrt(2 * share * map.shapes[at(t)].area);
            if (part == 0) wanted[4 * t] = weight;
            const Vector6 f = map.shapes[at(t)].functional(
                part % 2 == 0 ? Complex(1, 0) : Complex(0, 1), part >= 2);
            for (int i = 0; i < 6; ++i) {
                for (int k = variables.row_start[at(6 * t + i)];
                     k < variables.row_start[at(6 * t + i + 1)]; ++k) {
                    matrix(4 * t + part, variables.column[at(k)]) +=
                        weight * f[i] * variables.coefficient[at(k)];
                }
            }
        }
    }
    wanted -= matrix.rightCols(variables.chain_columns) * (variables.lattice * y);
    const Eigen::MatrixXd left = matrix.leftCols(variables.vertex_columns);
    const Eigen::VectorXd x = (left.transpose() * left).ldlt().solve(left.transpose() * wanted);
    return (left * x - wanted).squaredNorm();
}

TEST(SeamlessMap, StiffnessIsHowTheLeastEnergyGrows) {
    std::mt19937 random(6);
    for (const test::Surface& surface : {test::surface_of(test::sphere(2), "sphere"),
                                         test::surface_of(test::torus(12, 6), "torus"),
                                         test::surface_of(test::square(4), "square"),
                                         test::surface_of(test::cylinder(8, 4), "cylinder")}) {
        SCOPED_TRACE(surface.name);
        const test::PreparedMap map = test::prepare(surface, 60);
        const SeamlessMap seamless = solve(map);
        const Eigen::VectorXd& best = seamless.best_integers;
        ASSERT_GT(best.size(), 0);
        const double least = least_energy(map, best);
        for (int run = 0; run < 5; ++run) {
            const Eigen::VectorXd away = test::random_vector(best.size(), random);
            const double expected = least + away.dot(seamless.stiffness * away);
            EXPECT_NEAR(least_energy(map, best + away), expected, 1e-7 * (1 + expected));
        }
    }
}

}  // namespace
}  // namespace kinequad
