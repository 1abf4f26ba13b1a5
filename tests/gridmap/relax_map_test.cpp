#include "kinequad/gridmap/relax_map.h"

#include <gtest/gtest.h>

#include "gridmap/map_checks.h"
#include "kinequad/gridmap/quantize.h"
#include "kinequad/gridmap/refine_map.h"

namespace kinequad {
namespace {

/// The energy of `relax_map` by its definition: `sum_t A_t (|J - 1|^2 + 2 (turn_weight - 1) (Im
/// a)^2 + 2 (shear_weight - 1) (Im b)^2 + 0.1 ((|J|^2 + 1) / det J + det J - 4))`.
double distortion(const test::PreparedMap& map, const Eigen::VectorXd& x) {
    const std::vector<Complex> corners = map.variables.corner_coordinates(x);
    double sum = 0;
    for (std::size_t t = 0; t < map.shapes.size(); ++t) {
        const Complex a = map.shapes[t].conformal_part(&corners[3 * t]);
        const Complex b = map.shapes[t].anticonformal_part(&corners[3 * t]);
        Eigen::Matrix2d J;
        J << (a + b).real(), (b - a).imag(), (a + b).imag(), (a - b).real();
        const double det = J.determinant();
        EXPECT_GT(det, 0);
        sum += map.shapes[t].area * ((J - Eigen::Matrix2d::Identity()).squaredNorm() +
                                     2 * (turn_weight - 1) * a.imag() * a.imag() +
                                     2 * (shear_weight - 1) * b.imag() * b.imag() +
                                     0.1 * ((J.squaredNorm() + 1) / det + det - 4));
    }
    return sum;
}

/// A seamless map and the whole numbers it may go to.
struct Start {
    test::PreparedMap map;
    Eigen::VectorXd x;
    Eigen::VectorXd goal;
    double scale = 1;
};

Start start_of(const test::Surface& surface, double cells) {
    Start start{test::prepare(surface, cells), {}, {}, 1};
    const MapVariables& variables = start.map.variables;
    TriangleSystem system(variables);
    const SeamlessMap seamless = solve_seamless_map(variables, system, start.map.shapes, {});
    const ConeTriangulation cone(start.map.mesh, variables,
                                 variables.corner_coordinates(seamless.x), seamless.integers);
    const Quantization whole =
        quantize(cone, seamless.stiffness, seamless.best_integers, {cells}, Context{}).value();
    start.scale = whole.scale;
    start.map.shapes = target_shapes(start.map.mesh, whole.scale);
    start.x = whole.scale * seamless.x;
    start.goal = variables.lattice * whole.integers;
    return start;
}

Eigen::VectorXd relaxed(const Start& start, Eigen::VectorXd x, int steps) {
    TriangleSystem system(start.map.variables);
    return relax_map(start.map.variables, system, start.map.shapes, std::move(x), steps, Context{});
}

TEST(RelaxMap, LowersTheDistortionStepByStep) {
    for (const test::Surface& surface : test::map_surfaces()) {
        SCOPED_TRACE(surface.name);
        const Start start = start_of(surface, 400);
        double before = distortion(start.map, start.x);
        for (int steps = 1; steps <= 4; ++steps) {
            const Eigen::VectorXd x = relaxed(start, start.x, steps);
            const double after = distortion(start.map, x);
            EXPECT_LE(after, before * (1 + 1e-12) + 1e-9);
            before = after;
            EXPECT_LT((x - start.x).tail(start.map.variables.chain_columns).norm(), 1e-9)
                << "the chain columns have to stay";
        }
    }
}

TEST(RelaxMap, EndsWhereTheDistortionIsStationary) {
    // A wrong derivative would end elsewhere: the slope in any direction has to vanish.
    const Start start = start_of(test::surface_of(test::sphere(2)), 100);
    Eigen::VectorXd x = start.x;
    for (int i = 0; i < 40; ++i) x = relaxed(start, x, 1);
    std::mt19937 random(3);
    const double energy = distortion(start.map, x);
    for (int run = 0; run < 10; ++run) {
        Eigen::VectorXd direction = test::random_vector(x.size(), random);
        direction.tail(start.map.variables.chain_columns).setZero();
        constexpr double step = 1e-5;
        const double ahead = distortion(start.map, x + step * direction);
        const double behind = distortion(start.map, x - step * direction);
        EXPECT_NEAR((ahead - behind) / (2 * step), 0, 1e-5 * energy);
        EXPECT_GE(ahead, energy - 1e-9 * energy);
    }
}

TEST(RelaxMap, RecoversAFlatMapFromAPerturbedOne) {
    const Start start = start_of(test::flat_torus(8, 6), 48);
    std::mt19937 random(4);
    Eigen::VectorXd x = start.x;
    x.head(start.map.variables.vertex_columns) +=
        0.3 * test::random_vector(start.map.variables.vertex_columns, random);
    ASSERT_GT(distortion(start.map, x), 1);
    for (int i = 0; i < 20; ++i) x = relaxed(start, x, 1);
    EXPECT_NEAR(distortion(start.map, x), 0, 1e-9);
    EXPECT_LT((x - start.x).norm(), 1e-5);
}

TEST(BringToIntegers, ArrivesWithoutAFlip) {
    for (const test::Surface& surface : test::map_surfaces()) {
        SCOPED_TRACE(surface.name);
        const Start start = start_of(surface, 600);
        TriangleSystem system(start.map.variables);
        const Arrival arrival = bring_to_integers(start.map.variables, system, start.map.shapes,
                                                  start.x, start.goal, Context{});
        ASSERT_TRUE(arrival.arrived);
        EXPECT_EQ(arrival.x.tail(start.map.variables.chain_columns), start.goal);
        const std::vector<Complex> corners = start.map.variables.corner_coordinates(arrival.x);
        test::expect_injective(start.map.mesh, corners);
        for (int h = 0; h < 3 * start.map.mesh.triangle_count(); ++h) {
            if (!start.map.nodes[at(start.map.mesh.origin[at(h)])]) continue;
            EXPECT_LT(test::whole_distance(corners[at(h)].real()), 1e-8);
            EXPECT_LT(test::whole_distance(corners[at(h)].imag()), 1e-8);
        }
    }
}

TEST(BringToIntegers, StaysInjectiveWhereItCannotArrive) {
    // All nodes in one point: no map goes there.
    const Start start = start_of(test::surface_of(test::cube(4)), 200);
    TriangleSystem system(start.map.variables);
    const Arrival arrival = bring_to_integers(start.map.variables, system, start.map.shapes,
                                              start.x, 0 * start.goal, Context{});
    EXPECT_FALSE(arrival.arrived);
    test::expect_injective(start.map.mesh, start.map.variables.corner_coordinates(arrival.x));
}

/// Splits every `stride`-th edge.
std::vector<int> some_edges(const ChartedMesh& mesh, int stride) {
    std::vector<int> chosen;
    for (int h = 0; h < 3 * mesh.triangle_count(); h += stride) {
        if (mesh.twin[at(h)] < h) chosen.push_back(h);
    }
    return chosen;
}

TEST(RefineMap, KeepsTheMap) {
    for (const test::Surface& surface : test::map_surfaces()) {
        SCOPED_TRACE(surface.name);
        Start start = start_of(surface, 300);
        ChartedMesh& mesh = start.map.mesh;
        MapVariables& variables = start.map.variables;
        const double before = distortion(start.map, start.x);
        const Eigen::VectorXd chains = start.x.tail(variables.chain_columns);
        Eigen::VectorXd x = start.x;
        for (const int stride : {7, 5}) {
            const int vertices = mesh.vertex_count;
            const std::vector<int> edges = some_edges(mesh, stride);
            x = refine_map(mesh, variables, x, edges);
            EXPECT_EQ(mesh.vertex_count, vertices + static_cast<int>(edges.size()));
            ASSERT_EQ(x.size(), variables.columns());
            ASSERT_EQ(variables.row_start.size(), 2 * mesh.origin.size() + 1);
        }
        const std::vector<Complex> corners = variables.corner_coordinates(x);
        EXPECT_EQ(x.tail(variables.chain_columns), chains);
        test::expect_seamless(mesh, nullptr, corners);
        test::expect_injective(mesh, corners);
        // The same linear map in every part of a triangle: the same distortion.
        start.map.shapes = target_shapes(mesh, start.scale);
        EXPECT_NEAR(distortion(start.map, x), before, 1e-7 * (1 + before));
    }
}

TEST(RefineMap, NewColumnsKeepTheTransitions) {
    std::mt19937 random(5);
    for (const test::Surface& surface : test::map_surfaces()) {
        SCOPED_TRACE(surface.name);
        Start start = start_of(surface, 300);
        Eigen::VectorXd x =
            refine_map(start.map.mesh, start.map.variables, start.x, some_edges(start.map.mesh, 4));
        x += test::random_vector(x.size(), random);
        test::expect_seamless(start.map.mesh, nullptr, start.map.variables.corner_coordinates(x));
    }
}

TEST(RefineMap, ARefinedMapCanBeRelaxedFurther) {
    Start start = start_of(test::surface_of(test::sphere(2)), 100);
    Eigen::VectorXd coarse = start.x;
    for (int i = 0; i < 20; ++i) coarse = relaxed(start, coarse, 1);
    const double before = distortion(start.map, coarse);
    start.x =
        refine_map(start.map.mesh, start.map.variables, coarse, some_edges(start.map.mesh, 1));
    start.map.shapes = target_shapes(start.map.mesh, start.scale);
    EXPECT_NEAR(distortion(start.map, start.x), before, 1e-8 * before);
    Eigen::VectorXd fine = start.x;
    for (int i = 0; i < 20; ++i) fine = relaxed(start, fine, 1);
    EXPECT_LT(distortion(start.map, fine), before);
}

}  // namespace
}  // namespace kinequad
