#include "kinequad/relax/quad_cost.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace kinequad {
namespace {

constexpr FoldBarrier barrier{0.4, 4};

/// Sides of length `a` and `b` that meet at `angle`, in the plane z = 0.
QuadCorners parallelogram(double a, double b, double angle) {
    const Vector3 x(a, 0, 0);
    const Vector3 y(b * std::cos(angle), b * std::sin(angle), 0);
    return {Vector3::Zero(), x, x + y, y};
}

QuadCorners random_quad(std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(-0.3, 0.3);
    QuadCorners quad = parallelogram(1, 1, std::numbers::pi / 2);
    for (Vector3& corner : quad)
        corner += Vector3(uniform(random), uniform(random), uniform(random));
    return quad;
}

TEST(QuadCost, VanishesForRectanglesOnly) {
    EXPECT_NEAR(quad_cost(parallelogram(1, 1, std::numbers::pi / 2), barrier), 0, 1e-15);
    EXPECT_NEAR(quad_cost(parallelogram(3, 0.5, std::numbers::pi / 2), barrier), 0, 1e-15);
    EXPECT_GT(quad_cost(parallelogram(1, 1, 1.5), barrier), 1e-3);
}

TEST(QuadCost, OfARhombusIsFourSquaredCosines) {
    for (const double angle : {0.5, 1.0, 2.0}) {
        const QuadCorners rhombus = parallelogram(2, 2, angle);
        EXPECT_NEAR(least_scaled_jacobian(rhombus), std::sin(angle), 1e-14);
        EXPECT_NEAR(quad_cost(rhombus, barrier), 4 * std::pow(std::cos(angle), 2), 1e-13);
    }
    // Below the safe Jacobian each corner pays for what is missing, by its square.
    const double angle = 0.2;
    const double missing = 0.4 - std::sin(angle);
    EXPECT_NEAR(quad_cost(parallelogram(1, 2, angle), barrier),
                4 * std::pow(std::cos(angle), 2) + 4 * 4 * missing * missing, 1e-13);
}

TEST(CosinesAt, HaveTheGradientsOfFiniteDifferences) {
    std::mt19937 random(4);
    constexpr double step = 1e-6;
    for (int trial = 0; trial < 20; ++trial) {
        const QuadCorners quad = random_quad(random);
        for (std::size_t k = 0; k < 4; ++k) {
            const auto cosines = cosines_at(quad, k);
            for (int axis = 0; axis < 3; ++axis) {
                QuadCorners ahead = quad;
                QuadCorners behind = quad;
                ahead[k][axis] += step;
                behind[k][axis] -= step;
                const auto more = cosines_at(ahead, k);
                const auto less = cosines_at(behind, k);
                for (std::size_t i = 0; i < cosines.size(); ++i) {
                    EXPECT_NEAR((more[i].cosine - less[i].cosine) / (2 * step),
                                cosines[i].gradient[axis], 1e-8);
                }
            }
        }
    }
}

TEST(CosinesAt, AreThoseOfTheCost) {
    // A vertex is part of the angles of its own corner and both next to it: over all vertices each
    // corner is seen three times.
    std::mt19937 random(5);
    for (int trial = 0; trial < 20; ++trial) {
        const QuadCorners quad = random_quad(random);
        double sum = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            for (const CornerCosine& corner : cosines_at(quad, k)) {
                sum += corner.cosine * corner.cosine;
            }
        }
        EXPECT_NEAR(sum, 3 * quad_cost(quad, {-1, 0}), 1e-12);
    }
}

TEST(QuadCost, DoesNotChangeUnderSimilarityAndRenumbering) {
    std::mt19937 random(1);
    for (int run = 0; run < 100; ++run) {
        const QuadCorners quad = random_quad(random);
        const double cost = quad_cost(quad, barrier);
        const double jacobian = least_scaled_jacobian(quad);
        const Eigen::Quaterniond turn(Eigen::Vector4d::Random().normalized());
        for (const double scale : {1e-9, 1.0, 1e9}) {
            QuadCorners other;
            for (std::size_t k = 0; k < 4; ++k) {
                other[(k + 1) % 4] = scale * (turn * quad[k] + Vector3(1, 2, 3));
            }
            EXPECT_NEAR(quad_cost(other, barrier), cost, 1e-9);
            EXPECT_NEAR(least_scaled_jacobian(other), jacobian, 1e-9);
        }
    }
}

TEST(LeastScaledJacobian, IsNotPositiveForFoldedQuads) {
    QuadCorners quad = parallelogram(1, 1, std::numbers::pi / 2);
    quad[2] = Vector3(0.2, 0.2, 0);  // a dart
    EXPECT_LT(least_scaled_jacobian(quad), 0);
    quad[2] = Vector3(0.5, 0.5, 0);  // a triangle
    EXPECT_NEAR(least_scaled_jacobian(quad), 0, 1e-15);
    EXPECT_GT(quad_cost(quad, barrier), quad_cost(parallelogram(1, 1, 1.2), barrier));
}

TEST(QuadCost, IsFiniteForCollapsedQuads) {
    const QuadCorners point = {Vector3::Ones(), Vector3::Ones(), Vector3::Ones(), Vector3::Ones()};
    EXPECT_TRUE(std::isfinite(quad_cost(point, barrier)));
    EXPECT_LE(least_scaled_jacobian(point), 0);
}

TEST(AreaNormal, HasTwiceTheArea) {
    const Vector3 normal = area_normal(parallelogram(3, 2, 1));
    EXPECT_LT((normal - Vector3(0, 0, 2 * 3 * 2 * std::sin(1.0))).norm(), 1e-12);
}

TEST(FittedSquareCorner, KeepsASquare) {
    const QuadCorners square = parallelogram(2, 2, std::numbers::pi / 2);
    for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_LT((fitted_square_corner(square, Vector3::UnitZ(), k) - square[k]).norm(), 1e-15);
    }
}

TEST(FittedSquareCorner, MakesTheSquareOfLeastSquares) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform(-0.1, 0.1);
    for (int run = 0; run < 50; ++run) {
        const QuadCorners quad = random_quad(random);
        QuadCorners square;
        for (std::size_t k = 0; k < 4; ++k) {
            square[k] = fitted_square_corner(quad, Vector3::UnitZ(), k);
        }
        const Vector3 centre = (square[0] + square[2]) / 2;
        const auto distance = [&](const QuadCorners& other) {
            double sum = 0;
            for (std::size_t k = 0; k < 4; ++k) sum += (other[k] - quad[k]).squaredNorm();
            return sum;
        };
        for (std::size_t k = 0; k < 4; ++k) {
            const Vector3 spoke = square[k] - centre;
            EXPECT_LT((square[(k + 1) % 4] - centre - Vector3::UnitZ().cross(spoke)).norm(), 1e-14);
        }
        // No square nearby in that plane fits better.
        const double least = distance(square);
        for (int i = 0; i < 20; ++i) {
            const Vector3 shift(uniform(random), uniform(random), uniform(random));
            const Eigen::AngleAxisd turn(uniform(random), Vector3::UnitZ());
            const double scale = 1 + uniform(random);
            QuadCorners other;
            for (std::size_t k = 0; k < 4; ++k) {
                other[k] = centre + shift + scale * (turn * (square[k] - centre));
            }
            EXPECT_GE(distance(other), least - 1e-14);
        }
    }
}

}  // namespace
}  // namespace kinequad
