#include "kinequad/mesh/closest_points.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>
#include <random>

#include "kinequad/core/error.h"
#include "kinequad/mesh/closest_point_on_triangle.h"
#include "support/shapes.h"

namespace kinequad {
namespace {

Vector3 random_point(std::mt19937_64& random) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    const double x = uniform(random);
    const double y = uniform(random);
    return {x, y, uniform(random)};
}

/// Overlapping triangles of all sizes and thicknesses, some of them collapsed.
TriangleMesh random_soup(int count, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    TriangleMesh soup;
    soup.V.resize(3 * count, 3);
    soup.F.resize(count, 3);
    for (int t = 0; t < count; ++t) {
        const Vector3 center = random_point(random);
        const double size = std::pow(10.0, -(t % 5));
        for (int k = 0; k < 3; ++k) {
            soup.V.row(3 * t + k) = (center + size * random_point(random)).transpose();
            soup.F(t, k) = 3 * t + k;
        }
        if (t % 17 == 0) soup.V.row(3 * t + 2) = 0.5 * (soup.V.row(3 * t) + soup.V.row(3 * t + 1));
        if (t % 23 == 0) soup.V.row(3 * t + 1) = soup.V.row(3 * t);
    }
    return soup;
}

ClosestPoint search_all(const TriangleMesh& mesh, const Vector3& p) {
    ClosestPoint best;
    best.squared_distance = std::numeric_limits<double>::infinity();
    for (int t = 0; t < mesh.F.rows(); ++t) {
        const TrianglePoint found = closest_point_on_triangle(
            p, mesh.V.row(mesh.F(t, 0)).transpose(), mesh.V.row(mesh.F(t, 1)).transpose(),
            mesh.V.row(mesh.F(t, 2)).transpose());
        if (found.squared_distance < best.squared_distance) {
            best = {{t, found.barycentric}, found.squared_distance};
        }
    }
    return best;
}

void expect_same_as_brute_force(const TriangleMesh& mesh, const ClosestPoints& surface,
                                const Vector3& center, double size, int count) {
    std::mt19937_64 random(7);
    for (int i = 0; i < count; ++i) {
        const double reach = i % 3 == 0 ? 1 : (i % 3 == 1 ? 5 : 1000);
        Vector3 p = center + size * reach * random_point(random);
        if (i % 7 == 0) p = mesh.V.row(i % mesh.V.rows()).transpose();
        const ClosestPoint expected = search_all(mesh, p);
        const ClosestPoint found =
            surface.find(p, i % 2 == 0 ? -1 : i % static_cast<int>(mesh.F.rows()));
        ASSERT_EQ(found.squared_distance, expected.squared_distance) << "point " << i;
        ASSERT_EQ(found.point.triangle, expected.point.triangle) << "point " << i;
        ASSERT_EQ(found.point.barycentric, expected.point.barycentric) << "point " << i;
        const double exact = expected.squared_distance;
        const int hint = i % static_cast<int>(mesh.F.rows());
        for (const double near : {exact, 2 * exact}) {
            const ClosestPoint any = surface.find_unless_near(near, p, hint);
            ASSERT_LE(any.squared_distance, near) << "point " << i;
            const int t = any.point.triangle;
            const auto corner = [&](int k) {
                return Vector3(mesh.V.row(mesh.F(t, k)).transpose());
            };
            ASSERT_EQ(
                closest_point_on_triangle(p, corner(0), corner(1), corner(2)).squared_distance,
                any.squared_distance)
                << "point " << i;
        }
        if (exact == 0) continue;
        const ClosestPoint beyond = surface.find_unless_near(std::nextafter(exact, 0.0), p, hint);
        ASSERT_EQ(beyond.squared_distance, exact) << "point " << i;
        ASSERT_EQ(beyond.point.triangle, expected.point.triangle) << "point " << i;
    }
}

TEST(ClosestPoints, BindNobodyElseToOneThread) {
    const auto allowed = [] {
        return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    };
    const std::size_t before = allowed();
    const TriangleMesh mesh = random_soup(10, 1);
    const ClosestPoints surface(mesh.V, mesh.F);
    EXPECT_EQ(allowed(), before);
}

TEST(ClosestPointOnTriangle, FindsInsideSidesAndCorners) {
    const Vector3 a(0, 0, 0);
    const Vector3 b(2, 0, 0);
    const Vector3 c(0, 2, 0);
    const TrianglePoint above = closest_point_on_triangle({0.5, 0.5, 3}, a, b, c);
    EXPECT_NEAR(above.squared_distance, 9, 1e-14);
    EXPECT_NEAR((above.barycentric - Vector3(0.5, 0.25, 0.25)).norm(), 0, 1e-14);
    EXPECT_NEAR(closest_point_on_triangle({1, -2, 0}, a, b, c).squared_distance, 4, 1e-14);
    EXPECT_NEAR(closest_point_on_triangle({2, 2, 1}, a, b, c).squared_distance, 3, 1e-14);
    EXPECT_NEAR(closest_point_on_triangle({4, -1, 0}, a, b, c).squared_distance, 5, 1e-14);
    EXPECT_NEAR(closest_point_on_triangle({-1, -1, -1}, a, b, c).squared_distance, 3, 1e-14);
}

TEST(ClosestPointOnTriangle, IsNoFartherThanADenseSample) {
    std::mt19937_64 random(3);
    for (int i = 0; i < 300; ++i) {
        Vector3 a = random_point(random);
        Vector3 b = random_point(random);
        Vector3 c = random_point(random);
        if (i % 3 == 0) c = a + 0.3 * (b - a) + 1e-9 * c;
        if (i % 10 == 0) b = a;
        const Vector3 p = 2 * random_point(random);
        const TrianglePoint found = closest_point_on_triangle(p, a, b, c);
        const Vector3 foot =
            found.barycentric[0] * a + found.barycentric[1] * b + found.barycentric[2] * c;
        EXPECT_GE(found.barycentric.minCoeff(), 0);
        EXPECT_NEAR(found.barycentric.sum(), 1, 1e-14);
        EXPECT_NEAR((p - foot).squaredNorm(), found.squared_distance, 1e-12);
        double sampled = std::numeric_limits<double>::infinity();
        const int n = 60;
        for (int u = 0; u <= n; ++u) {
            for (int v = 0; u + v <= n; ++v) {
                const Vector3 q = (u * a + v * b + (n - u - v) * c) / n;
                sampled = std::min(sampled, (p - q).squaredNorm());
            }
        }
        EXPECT_LE(found.squared_distance, sampled + 1e-12);
        EXPECT_GE(found.squared_distance, sampled - 0.3);
    }
}

TEST(ClosestPoints, AgreesWithBruteForceOnSoups) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const TriangleMesh soup = random_soup(400, seed);
        expect_same_as_brute_force(soup, ClosestPoints(soup.V, soup.F), Vector3::Zero(), 1, 400);
    }
}

TEST(ClosestPoints, AgreesWithBruteForceAtEveryScaleAndFarFromTheOrigin) {
    for (const double scale : {1e-12, 1e-3, 1e12}) {
        TriangleMesh soup = random_soup(300, 5);
        soup.V *= scale;
        expect_same_as_brute_force(soup, ClosestPoints(soup.V, soup.F), Vector3::Zero(), scale,
                                   300);
    }
    TriangleMesh soup = random_soup(300, 6);
    const Vector3 offset(1e7, -3e7, 5e6);
    soup.V.rowwise() += offset.transpose();
    expect_same_as_brute_force(soup, ClosestPoints(soup.V, soup.F), offset, 1, 300);
}

TEST(ClosestPoints, AgreesWithBruteForceAfterUpdates) {
    TriangleMesh soup = random_soup(400, 8);
    ClosestPoints surface(soup.V, soup.F);
    for (const std::uint64_t seed : {9U, 10U}) {
        soup = random_soup(400, seed);
        soup.F.col(0).swap(soup.F.col(2));
        surface.update(soup.V, soup.F);
        expect_same_as_brute_force(soup, surface, Vector3::Zero(), 1, 300);
    }
    soup = random_soup(150, 11);
    surface.update(soup.V, soup.F);
    expect_same_as_brute_force(soup, surface, Vector3::Zero(), 1, 300);
}

TEST(ClosestPoints, TakesTheLowestOfEqualTriangles) {
    const TriangleMesh cube = test::cube(4);
    TriangleMesh twice = cube;
    twice.F.resize(2 * cube.F.rows(), 3);
    twice.F << cube.F, cube.F;
    const ClosestPoints surface(twice.V, twice.F);
    for (int t = 0; t < cube.F.rows(); ++t) {
        const Vector3 middle =
            (cube.V.row(cube.F(t, 0)) + cube.V.row(cube.F(t, 1)) + cube.V.row(cube.F(t, 2)))
                .transpose() /
            3;
        const int hint = t + static_cast<int>(cube.F.rows());
        EXPECT_EQ(surface.find(1.01 * middle, hint).point.triangle, t);
    }
}

TEST(ClosestPoints, WorksOnASingleCollapsedTriangle) {
    Positions V = Positions::Constant(3, 3, 2.0);
    Triangles F(1, 3);
    F << 0, 1, 2;
    const ClosestPoints surface(V, F);
    EXPECT_NEAR(surface.find({2, 2, 5}).squared_distance, 9, 1e-14);
}

TEST(ClosestPoints, RefusesWhatIsNoSurface) {
    const TriangleMesh square = test::square(2);
    EXPECT_THROW(ClosestPoints(square.V, Triangles(0, 3)), InputError);
    Triangles F = square.F;
    F(0, 0) = static_cast<int>(square.V.rows());
    EXPECT_THROW(ClosestPoints(square.V, F), InputError);
    Positions V = square.V;
    V(3, 1) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(ClosestPoints(V, square.F), InputError);
}

}  // namespace
}  // namespace kinequad
