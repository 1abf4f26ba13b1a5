#include "kinequad/field/compute_cross_field.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <atomic>
#include <cmath>
#include <numbers>

#include "field/surfaces.h"
#include "kinequad/core/error.h"
#include "kinequad/field/verify_cross_field.h"

namespace kinequad {
namespace {

using test::count_singular;
using test::field_of;
using test::random_targets;
using test::Surface;
using test::surface_of;

using std::numbers::pi;
constexpr auto both_methods = {CrossFieldMethod::convex, CrossFieldMethod::paper};

/// Distance of an angle to the nearest quarter turn, radians.
double off_quarters(double angle) { return std::abs(std::remainder(angle, pi / 2)); }

TEST(CrossField, OfACubeHasItsCornersAndNoEnergy) {
    for (const int n : {1, 2, 8}) {
        const Surface cube = surface_of(test::cube(n));
        const CrossField field = field_of(cube);
        EXPECT_NEAR(field.energy, 0, 1e-18);
        for (int v = 0; v < cube.topology.vertex_count; ++v) {
            const bool corner = angle_defects(cube.topology, cube.metric)[v] > 1;
            EXPECT_EQ(field.index[v], corner ? 1 : 0);
        }
    }
}

TEST(CrossField, OfASquareHasItsFourCorners) {
    for (const CrossFieldMethod method : both_methods) {
        const Surface square = surface_of(test::square(6));
        const CrossField field = field_of(square, {}, {.method = method});
        EXPECT_NEAR(field.energy, 0, 1e-18);
        EXPECT_EQ(count_singular(field), 4);
        for (const int v : {0, 6, 42, 48}) EXPECT_EQ(field.index[v], 1);
    }
}

TEST(CrossField, OfASquareRingHasConvexAndReflexCorners) {
    // A square without its middle: four corners of +1, four of -1.
    const TriangleMesh full = test::square(3);
    TriangleMesh ring{full.V, Triangles(16, 3)};
    for (int t = 0, kept = 0; t < 18; ++t) {
        if (t / 2 != 4) ring.F.row(kept++) = full.F.row(t);
    }
    const CrossField field = field_of(surface_of(ring));
    EXPECT_NEAR(field.energy, 0, 1e-18);
    for (const int v : {0, 3, 12, 15}) EXPECT_EQ(field.index[v], 1);
    for (const int v : {5, 6, 9, 10}) EXPECT_EQ(field.index[v], -1);
    EXPECT_EQ(count_singular(field), 8);
}

TEST(CrossField, OfAnOpenCylinderIsRegular) {
    const CrossField field = field_of(surface_of(test::cylinder(24, 10)));
    EXPECT_EQ(count_singular(field), 0);
    EXPECT_NEAR(field.energy, 0, 1e-18);
}

TEST(CrossField, OfASphereHasEightSingularities) {
    const CrossField field = field_of(surface_of(test::sphere(4)));
    EXPECT_EQ(field.index.sum(), 8);
    EXPECT_EQ(count_singular(field), 8);
    EXPECT_EQ(field.index.maxCoeff(), 1);
}

TEST(CrossField, OnAFlatTorusFollowsAUniformTarget) {
    const Surface torus = test::flat_torus(9, 7);
    for (const double angle : {0.0, 0.3, -0.7, pi / 4}) {
        for (const CrossFieldMethod method : both_methods) {
            CrossFieldTargets targets = random_targets(torus.topology, 3, 1);
            for (int t = 0; t < torus.topology.triangle_count; ++t) {
                // The second triangle of each square has its x-axis along the diagonal.
                targets.value[t] = std::polar(1.0, 4 * (angle - (t % 2 == 0 ? 0 : pi / 4)));
            }
            const CrossField field = field_of(torus, targets, {.method = method});
            EXPECT_EQ(count_singular(field), 0);
            EXPECT_NEAR(field.energy, 0, 1e-16);
            EXPECT_NEAR(off_quarters(field.angle[0] - angle), 0, 1e-9);
        }
    }
}

TEST(CrossField, OnAFlatTorusWithoutTargetsIsParallel) {
    const CrossField field = field_of(test::flat_torus(9, 7));
    EXPECT_EQ(count_singular(field), 0);
    EXPECT_NEAR(field.energy, 0, 1e-16);
}

TEST(CrossField, IndicesSumToFourTimesTheEulerCharacteristic) {
    const std::vector<Surface> surfaces = test::all_surfaces();
    rc::check([&] {
        const Surface& surface = surfaces[*rc::gen::inRange<std::size_t>(0, surfaces.size())];
        const auto seed = *rc::gen::inRange<unsigned>(0, 1000);
        const double weight = *rc::gen::element(1e-9, 1e-3, 0.1, 10.0, 1e4);
        CrossFieldOptions options;
        options.method = *rc::gen::element(CrossFieldMethod::convex, CrossFieldMethod::paper);
        options.edge_length = *rc::gen::element(0.0, 0.2, 2.0);
        const CrossFieldTargets targets = random_targets(surface.topology, seed, weight);
        const CrossField field = field_of(surface, targets, options);
        const CrossFieldReport report =
            verify_cross_field(surface.topology, surface.metric, field, options);
        RC_ASSERT(report.valid());
        RC_ASSERT(report.index_sum == report.expected_index_sum);
        RC_ASSERT(field.angle.cwiseAbs().maxCoeff() <= pi / 4 + 1e-12);
    });
}

TEST(CrossField, IsAlignedWithBoundaryFeaturesAndFixedDirections) {
    const Surface square = surface_of(test::square(8));
    CrossFieldOptions options;
    // The diagonals of one column cross the sides' directions at 45 degrees.
    const int feature = square.topology.edge[3 * 68 + 2];
    options.feature_edges = {feature};
    options.fixed_directions = {{37, 0.2},
                                {0, 0.4}};  // triangle 0 lies on the boundary, which wins
    for (const CrossFieldMethod method : both_methods) {
        options.method = method;
        const CrossField field = field_of(square, {}, options);
        EXPECT_TRUE(verify_cross_field(square.topology, square.metric, field, options).valid());
        const int h = square.topology.edge_half_edge[static_cast<std::size_t>(feature)];
        for (const int side : {h, square.topology.twin[static_cast<std::size_t>(h)]}) {
            const auto directions =
                half_edge_directions(side_lengths(square.topology, square.metric, side / 3));
            EXPECT_NEAR(off_quarters(field.angle[side / 3] -
                                     directions[static_cast<std::size_t>(side % 3)]),
                        0, 1e-9);
        }
        EXPECT_NEAR(off_quarters(field.angle[37] - 0.2), 0, 1e-9);
        EXPECT_NEAR(off_quarters(field.angle[0]), 0, 1e-9);
    }
}

TEST(CrossField, WithFeaturesOfACubeIsTheOneWithout) {
    const Surface cube = surface_of(test::cube(4));
    CrossFieldOptions options;
    for (int e = 0; e < cube.topology.edge_count; ++e) {
        const int h = cube.topology.edge_half_edge[static_cast<std::size_t>(e)];
        // The first row of squares of each side begins at an edge of the cube; so do other rows,
        // and both ways round the field is aligned with all sides of squares.
        if (cube.metric.edge_length[e] < 0.6 && h % 7 == 0) options.feature_edges.push_back(e);
    }
    const CrossField field = field_of(cube, {}, options);
    EXPECT_NEAR(field.energy, 0, 1e-18);
    EXPECT_EQ(count_singular(field), 8);
}

TEST(CrossField, FollowsStrongTargets) {
    const Surface sphere = surface_of(test::sphere(3));
    const CrossFieldTargets targets = random_targets(sphere.topology, 5, 0);
    CrossFieldTargets strong = targets;
    strong.weight.setConstant(1e6);
    for (const CrossFieldMethod method : both_methods) {
        const CrossField field = field_of(sphere, strong, {.method = method});
        for (int t = 0; t < sphere.topology.triangle_count; ++t) {
            EXPECT_NEAR(off_quarters(field.angle[t] - std::arg(strong.value[t]) / 4), 0, 1e-4);
        }
    }
}

TEST(CrossField, LeavesEveryVertexAnAngle) {
    for (unsigned seed = 0; seed < 10; ++seed) {
        for (const CrossFieldMethod method : both_methods) {
            const Surface sphere = surface_of(test::sphere(3));
            const CrossFieldTargets targets = random_targets(sphere.topology, seed, 2);
            const CrossField field = field_of(sphere, targets, {.method = method});
            const auto report = verify_cross_field(sphere.topology, sphere.metric, field, {});
            EXPECT_EQ(report.angleless_vertices, 0);
        }
    }
}

TEST(CrossField, TakesSingularitiesOfSeveralQuartersApart) {
    // Two squares sewn up along their sides: the field without energy has +2 at each corner, where
    // two quads would share two edges.
    const int n = 8;
    const TriangleMesh front = test::square(n);
    const auto inside = [](int i) { return i > 0 && i < n; };
    std::vector<int> back(static_cast<std::size_t>((n + 1) * (n + 1)));
    int count = (n + 1) * (n + 1);
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= n; ++j) {
            const int v = i * (n + 1) + j;
            back[static_cast<std::size_t>(v)] = inside(i) && inside(j) ? count++ : v;
        }
    }
    TriangleMesh pillow{Positions(count, 3), Triangles(2 * front.F.rows(), 3)};
    for (std::size_t v = 0; v < back.size(); ++v) {
        pillow.V.row(static_cast<Eigen::Index>(v)) = front.V.row(static_cast<Eigen::Index>(v));
        pillow.V.row(back[v]) = front.V.row(static_cast<Eigen::Index>(v));
    }
    pillow.F.topRows(front.F.rows()) = front.F;
    // Turned by a quarter: no diagonal of the back joins the same corners' neighbours as one in
    // front.
    const auto turned = [](int v) { return v % (n + 1) * (n + 1) + n - v / (n + 1); };
    for (Eigen::Index t = 0; t < front.F.rows(); ++t) {
        for (int k = 0; k < 3; ++k) {
            const int v = turned(front.F(t, 2 - k));
            pillow.F(front.F.rows() + t, k) = back[static_cast<std::size_t>(v)];
        }
    }
    for (const double edge_length : {0.0, 0.05, 0.2}) {
        const CrossField field = field_of(surface_of(pillow), {}, {.edge_length = edge_length});
        EXPECT_EQ(count_singular(field), 8) << edge_length;
        EXPECT_EQ(field.index.maxCoeff(), 1) << edge_length;
        EXPECT_EQ(field.index.minCoeff(), 0) << edge_length;
    }
}

TEST(CrossField, WithDearerSingularitiesHasFewer) {
    const Surface sphere = surface_of(test::sphere(3));
    const CrossFieldTargets targets = random_targets(sphere.topology, 6, 1);
    int last = 1000;
    for (const double cost : {0.0, 0.2, 2.0, 1e3}) {
        const int count = count_singular(field_of(sphere, targets, {.singularity_cost = cost}));
        EXPECT_LE(count, last);
        last = count;
    }
    EXPECT_EQ(last, 8);
}

TEST(CrossField, KeepsSingularitiesApartThatQuadsCannotTellApart) {
    const Surface cube = surface_of(test::cube(1));
    // Quads as large as the cube have no room for all corners; small ones have.
    EXPECT_EQ(count_singular(field_of(cube, {}, {.edge_length = 0.1})), 8);
    EXPECT_LT(count_singular(field_of(cube, {}, {.adjacency_cost = 5, .edge_length = 10})), 8);
}

TEST(CrossField, DoesNotDependOnTheUnitOfLength) {
    const Surface sphere = surface_of(test::sphere(3));
    const CrossFieldTargets targets = random_targets(sphere.topology, 11, 0.3);
    const CrossField field = field_of(sphere, targets, {.edge_length = 0.3});
    for (const double scale : {1e-8, 1e8}) {
        Surface scaled = sphere;
        scaled.metric.edge_length *= scale;
        const CrossField other = field_of(scaled, targets, {.edge_length = 0.3 * scale});
        EXPECT_EQ(other.index, field.index);
        EXPECT_NEAR(other.energy, field.energy, 1e-6);
    }
}

TEST(CrossField, DoesNotDependOnTheNumbering) {
    const TriangleMesh mesh = test::torus(30, 16);
    const Surface surface = surface_of(mesh);
    const CrossFieldTargets targets = random_targets(surface.topology, 2, 0.5);
    std::mt19937 random(4);
    std::vector<int> vertex(static_cast<std::size_t>(mesh.V.rows()));
    std::vector<int> triangle(static_cast<std::size_t>(mesh.F.rows()));
    std::iota(vertex.begin(), vertex.end(), 0);
    std::iota(triangle.begin(), triangle.end(), 0);
    std::shuffle(vertex.begin(), vertex.end(), random);
    std::shuffle(triangle.begin(), triangle.end(), random);

    TriangleMesh other{Positions(mesh.V.rows(), 3), Triangles(mesh.F.rows(), 3)};
    CrossFieldTargets moved = targets;
    for (int v = 0; v < mesh.V.rows(); ++v) {
        other.V.row(vertex[static_cast<std::size_t>(v)]) = mesh.V.row(v);
    }
    for (int t = 0; t < mesh.F.rows(); ++t) {
        const int to = triangle[static_cast<std::size_t>(t)];
        const int first = t % 3;
        for (int k = 0; k < 3; ++k) {
            other.F(to, k) = vertex[static_cast<std::size_t>(mesh.F(t, (k + first) % 3))];
        }
        const auto directions =
            half_edge_directions(side_lengths(surface.topology, surface.metric, t));
        moved.value[to] =
            targets.value[t] * std::polar(1.0, -4 * directions[static_cast<std::size_t>(first)]);
        moved.weight[to] = targets.weight[t];
    }
    const Surface renumbered = surface_of(other);
    const CrossField a = field_of(surface, targets, {.edge_length = 0.15});
    const CrossField b = field_of(renumbered, moved, {.edge_length = 0.15});
    EXPECT_NEAR(a.energy, b.energy, 1e-9 * a.energy);
    for (int v = 0; v < mesh.V.rows(); ++v) {
        EXPECT_EQ(a.index[v], b.index[vertex[static_cast<std::size_t>(v)]]);
    }
}

TEST(CrossField, SameBytesOnAnyNumberOfThreads) {
    const Surface torus = surface_of(test::torus(40, 20));
    const CrossFieldTargets targets = random_targets(torus.topology, 8, 0.2);
    Context context;
    context.threads = 1;
    const CrossField one = compute_cross_field(torus.topology, torus.metric, targets, {}, context);
    for (const int threads : {2, 8}) {
        context.threads = threads;
        const CrossField many =
            compute_cross_field(torus.topology, torus.metric, targets, {}, context);
        EXPECT_EQ(many.angle, one.angle);
        EXPECT_EQ(many.period_jump, one.period_jump);
    }
}

TEST(CrossField, OfSeveralComponentsIsTheFieldOfEach) {
    const TriangleMesh cube = test::cube(2);
    const Eigen::Index n = cube.V.rows();
    const Eigen::Index m = cube.F.rows();
    TriangleMesh two{Positions(2 * n, 3), Triangles(2 * m, 3)};
    two.V << cube.V, 3 * cube.V;
    two.F << cube.F, (cube.F.array() + static_cast<int>(n)).matrix();
    const CrossField field = field_of(surface_of(two), {}, {.edge_length = 0.5});
    EXPECT_EQ(field.index.sum(), 16);
    EXPECT_EQ(count_singular(field), 16);
}

TEST(CrossField, RefusesWhatDoesNotExist) {
    const Surface cube = surface_of(test::cube(1));
    CrossFieldOptions options;
    options.feature_edges = {18};
    EXPECT_THROW(field_of(cube, {}, options), InputError);
    options = {};
    options.fixed_directions = {{12, 0}};
    EXPECT_THROW(field_of(cube, {}, options), InputError);
    options.fixed_directions = {{0, std::nan("")}};
    EXPECT_THROW(field_of(cube, {}, options), InputError);
    EXPECT_THROW(field_of(cube, random_targets(surface_of(test::cube(2)).topology, 1, 1)),
                 InputError);
}

TEST(CrossField, StopsWhenAsked) {
    const Surface cube = surface_of(test::cube(1));
    const std::atomic<bool> cancel = true;
    Context context;
    context.cancel = &cancel;
    EXPECT_THROW(compute_cross_field(cube.topology, cube.metric, {}, {}, context), Cancelled);
}

}  // namespace
}  // namespace kinequad
