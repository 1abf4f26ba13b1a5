#include "kinequad/gridmap/cone_triangulation.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "gridmap/map_checks.h"
#include "kinequad/gridmap/quantize.h"

namespace kinequad {
namespace {

double product(const LinearForm<double>& form, const Eigen::VectorXd& y) {
    double sum = 0;
    for (const auto& [unknown, c] : form) sum += c * y[unknown];
    return sum;
}

std::size_t edges_shorter(const ConeTriangulation& cone, double length) {
    const std::vector<int> edges = cone.edges();
    return static_cast<std::size_t>(std::count_if(
        edges.begin(), edges.end(), [&](int h) { return cone.edge_length(h) < length; }));
}

struct ConeMap {
    test::PreparedMap map;
    SeamlessMap seamless;
    ConeTriangulation cone;
};

ConeMap cones_of(const test::Surface& surface, double cells) {
    test::PreparedMap map = test::prepare(surface, cells);
    TriangleSystem system(map.variables);
    SeamlessMap seamless = solve_seamless_map(map.variables, system, map.shapes, {});
    ConeTriangulation cone(map.mesh, map.variables, map.variables.corner_coordinates(seamless.x),
                           seamless.integers);
    return {std::move(map), std::move(seamless), std::move(cone)};
}

std::vector<double> determinants(const ConeTriangulation& cone) {
    std::vector<double> values;
    for (int i = 0; i < cone.triangle_count(); ++i) values.push_back(cone.determinant(i));
    return values;
}

void expect_same(std::vector<double> a, std::vector<double> b, double tolerance) {
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], tolerance);
}

TEST(ConeTriangulation, TakesOutAllButTheNodesAndKeepsTheArea) {
    for (const test::Surface& surface : test::map_surfaces()) {
        SCOPED_TRACE(surface.name);
        const ConeMap it = cones_of(surface, 300);
        int nodes = 0;
        int boundary_nodes = 0;
        for (int v = 0; v < it.map.mesh.vertex_count; ++v) {
            if (!it.map.nodes[at(v)]) continue;
            ++nodes;
            boundary_nodes += it.map.mesh.is_boundary[at(v)];
        }
        // Euler's formula; on a sphere 2 (nodes - 2).
        const int characteristic = count_surface(surface.topology).euler_characteristic;
        EXPECT_EQ(it.cone.triangle_count(), 2 * (nodes - characteristic) - boundary_nodes);
        const std::vector<Complex> corners = it.map.variables.corner_coordinates(it.seamless.x);
        double area = 0;
        for (int t = 0; t < it.map.mesh.triangle_count(); ++t) {
            area += test::determinant(corners, t) / 2;
        }
        EXPECT_NEAR(it.cone.area(), area, 1e-7 * area);
        for (const double d : determinants(it.cone)) EXPECT_GT(d, 0);
        EXPECT_EQ(it.cone.integers(), it.seamless.integers);
    }
}

TEST(ConeTriangulation, ACubeIsTheDelaunayTriangulationOfItsCorners) {
    const ConeMap it = cones_of(test::surface_of(test::cube(5)), 600);
    ASSERT_EQ(it.cone.triangle_count(), 12);
    for (const double d : determinants(it.cone)) EXPECT_NEAR(d, 100, 1e-6);
    EXPECT_EQ(edges_shorter(it.cone, 10.001), 12U);
    EXPECT_EQ(edges_shorter(it.cone, 9.999), 0U);
    EXPECT_EQ(edges_shorter(it.cone, 15), 18U);
}

TEST(ConeTriangulation, MovingThereAndBackRestores) {
    std::mt19937 random(8);
    for (const test::Surface& surface : test::map_surfaces()) {
        SCOPED_TRACE(surface.name);
        const ConeMap it = cones_of(surface, 400);
        const std::vector<double> before = determinants(it.cone);
        const double area = it.cone.area();
        int moved = 0;
        for (int run = 0; run < 20; ++run) {
            const Eigen::VectorXd step =
                2 * test::random_vector(it.seamless.integers.size(), random);
            ConeTriangulation cone = it.cone;
            if (!cone.move(step)) continue;
            ++moved;
            for (const double d : determinants(cone)) EXPECT_GT(d, 0);
            const bool is_back = cone.move(-step);
            // Cones in line may be in each other's way on the way back to a flat shape.
            if (surface.name == "sphere" || surface.name == "torus") {
                ASSERT_TRUE(is_back);
            }
            if (!is_back) continue;
            for (const double d : determinants(cone)) EXPECT_GT(d, 0);
            EXPECT_LT((cone.integers() - it.seamless.integers).norm(), 1e-9);
            // Where four cones lie on a circle either diagonal is Delaunay.
            if (surface.name == "sphere") expect_same(determinants(cone), before, 1e-7);
            EXPECT_NEAR(cone.area(), area, 1e-7 * area);
        }
        EXPECT_GT(moved, 0);
    }
}

TEST(ConeTriangulation, ABlockedMoveChangesNothing) {
    for (const test::Surface& surface : test::map_surfaces()) {
        SCOPED_TRACE(surface.name);
        ConeMap it = cones_of(surface, 300);
        const std::vector<double> before = determinants(it.cone);
        // Beyond the point where all nodes meet.
        EXPECT_FALSE(it.cone.move(-1.5 * it.seamless.integers));
        EXPECT_EQ(it.cone.integers(), it.seamless.integers);
        const std::vector<double> after = determinants(it.cone);
        ASSERT_EQ(after.size(), before.size());
        for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(after[i], before[i], 1e-9);
        // And it still moves.
        EXPECT_TRUE(it.cone.move(0.1 * it.seamless.integers));
    }
}

TEST(ConeTriangulation, ScaleIsThatOfAllPositions) {
    ConeMap it = cones_of(test::surface_of(test::sphere(3)), 300);
    std::vector<double> expected = determinants(it.cone);
    for (double& d : expected) d *= 4;
    ConeTriangulation moved = it.cone;
    it.cone.scale(2);
    expect_same(determinants(it.cone), expected, 1e-8);
    // A move along the positions themselves does the same.
    ASSERT_TRUE(moved.move(it.seamless.integers));
    expect_same(determinants(moved), expected, 1e-7);
}

TEST(ConeTriangulation, GradientsAreTheDifferences) {
    for (const test::Surface& surface : test::map_surfaces()) {
        SCOPED_TRACE(surface.name);
        const ConeMap it = cones_of(surface, 300);
        std::mt19937 random(9);
        const Eigen::VectorXd direction = test::random_vector(it.seamless.integers.size(), random);
        constexpr double step = 1e-5;
        // `snap` sets positions without flips.
        ConeTriangulation ahead = it.cone;
        ConeTriangulation behind = it.cone;
        ahead.snap(it.seamless.integers + step * direction);
        behind.snap(it.seamless.integers - step * direction);
        for (int i = 0; i < it.cone.triangle_count(); ++i) {
            EXPECT_NEAR(product(it.cone.determinant_gradient(i), direction),
                        (ahead.determinant(i) - behind.determinant(i)) / (2 * step), 1e-5);
        }
        for (const int h : it.cone.edges()) {
            EXPECT_NEAR(product(it.cone.edge_length_gradient(h), direction),
                        (ahead.edge_length(h) - behind.edge_length(h)) / (2 * step), 1e-5);
        }
    }
}

TEST(Quantize, GivesWholeNumbersNearTheWantedCount) {
    for (const test::Surface& surface : test::map_surfaces()) {
        SCOPED_TRACE(surface.name);
        const ConeMap it = cones_of(surface, 600);
        const std::optional<Quantization> found =
            quantize(it.cone, it.seamless.stiffness, it.seamless.best_integers, {600}, Context{});
        ASSERT_TRUE(found);
        const Quantization& whole = *found;
        for (const double y : whole.integers) EXPECT_EQ(y, std::round(y));
        EXPECT_NEAR(whole.quads, 600, 0.05 * 600);
        EXPECT_EQ(whole.quads, std::round(whole.quads));
        EXPECT_NEAR(whole.scale, 1, 0.2);
        // Where the straight way there is open, whole triangles of at least half a cell arrive.
        ConeTriangulation cone = it.cone;
        cone.scale(whole.scale);
        if (!cone.move(whole.integers - cone.integers())) continue;
        EXPECT_NEAR(cone.area(), whole.quads, 1e-6);
        for (int i = 0; i < cone.triangle_count(); ++i) {
            EXPECT_GE(cone.determinant(i), 1 - 1e-9);
            EXPECT_LT(test::whole_distance(cone.determinant(i)), 1e-8);
        }
    }
}

TEST(Quantize, KeepsWholeNumbersThatAreThere) {
    const ConeMap it = cones_of(test::flat_torus(8, 6), 48);
    const std::optional<Quantization> found =
        quantize(it.cone, it.seamless.stiffness, it.seamless.best_integers, {48}, Context{});
    ASSERT_TRUE(found);
    const Quantization& whole = *found;
    EXPECT_EQ(whole.quads, 48);
    EXPECT_NEAR(whole.scale, 1, 1e-9);
}

}  // namespace
}  // namespace kinequad
