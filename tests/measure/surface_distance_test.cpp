#include "kinequad/measure/surface_distance.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "kinequad/core/error.h"
#include "support/shapes.h"

namespace kinequad {
namespace {

using test::cube;
using test::sphere;
using test::square;

TriangleMesh moved(TriangleMesh mesh, const Eigen::RowVector3d& by) {
    mesh.V.rowwise() += by;
    return mesh;
}

TriangleMesh scaled(TriangleMesh mesh, double by) {
    mesh.V *= by;
    return mesh;
}

/// The bound is above the value, and by no more than the tolerance.
void expect_tight(const DirectedDistance& d) {
    const DistanceOptions options;
    EXPECT_GE(d.hausdorff_bound_percent, d.hausdorff_percent);
    EXPECT_LE(d.hausdorff_bound_percent, d.hausdorff_percent * (1 + options.relative_tolerance) +
                                             options.absolute_tolerance_percent * (1 + 1e-12));
}

TEST(SurfaceDistance, IsZeroForTheSameSurface) {
    const TriangleMesh mesh = test::torus(20, 12);
    TriangleMesh turned = mesh;
    turned.F.col(0) = mesh.F.col(1);
    turned.F.col(1) = mesh.F.col(2);
    turned.F.col(2) = mesh.F.col(0);
    const SurfaceDistance d = measure_distance(mesh, turned);
    EXPECT_NEAR(d.hausdorff_percent(), 0, 1e-12);
    EXPECT_NEAR(d.mean_percent(), 0, 1e-12);
    expect_tight(d.quads_to_input);
}

TEST(SurfaceDistance, IsTheOffsetOfParallelPlanes) {
    const double offset = 0.03;
    const SurfaceDistance d = measure_distance(square(7), moved(square(4), {0, 0, offset}));
    const double expected = 100 * offset / std::sqrt(2.0);
    for (const DirectedDistance& one : {d.quads_to_input, d.input_to_quads}) {
        EXPECT_NEAR(one.hausdorff_percent, expected, 1e-10);
        EXPECT_NEAR(one.mean_percent, expected, 1e-10);
        expect_tight(one);
    }
}

TEST(SurfaceDistance, FindsASpikeHoweverSmall) {
    TriangleMesh spiked = square(200);
    const Eigen::Index tip = 100 * 201 + 100;
    const double height = 0.05;
    spiked.V(tip, 2) = height;
    const TriangleMesh flat = square(3);
    const SurfaceDistance d = measure_distance(flat, spiked);
    EXPECT_NEAR(d.quads_to_input.hausdorff_percent, 100 * height / std::sqrt(2.0), 1e-10);
    EXPECT_LT(d.quads_to_input.mean_percent, 0.002);
    expect_tight(d.quads_to_input);
    // Back from the plane the spike's foot is farthest, less than a triangle's side away. No sample
    // has to hit it, but the bound knows of it.
    const double side = 100 * (1.0 / 200) / std::sqrt(2.0);
    const double foot =
        std::sqrt(ClosestPoints(spiked.V, spiked.F).find({0.5, 0.5, 0}).squared_distance);
    EXPECT_LT(d.input_to_quads.hausdorff_percent, side);
    EXPECT_GE(d.input_to_quads.hausdorff_bound_percent, 100 * foot / std::sqrt(2.0));
}

TEST(SurfaceDistance, FindsTheFarthestPointInsideALargeTriangle) {
    // The middle of a square of two triangles lies farthest above a pit that is elsewhere flat.
    TriangleMesh pit = square(2);
    pit.V(4, 2) = -0.3;
    const TriangleMesh lid = square(1);
    const SurfaceDistance d = measure_distance(pit, lid);
    const double diagonal = bounding_box_diagonal(pit.V);
    EXPECT_NEAR(d.input_to_quads.hausdorff_percent, 100 * 0.3 / diagonal, 1e-10);
    // The pit's steepest sides rise by 0.3 over a quarter of the square's diagonal.
    const double run = std::sqrt(2.0) / 4;
    const double expected = 0.3 * run / std::hypot(0.3, run);
    EXPECT_NEAR(d.quads_to_input.hausdorff_percent, 100 * expected / diagonal, 1e-10);
    expect_tight(d.quads_to_input);
}

TEST(SurfaceDistance, IsTheGapOfConcentricSpheres) {
    const TriangleMesh outer = sphere(5);
    const TriangleMesh inner = scaled(outer, 0.9);
    const SurfaceDistance d = measure_distance(outer, inner);
    const double percent = 100 / bounding_box_diagonal(outer.V);
    EXPECT_NEAR(d.quads_to_input.hausdorff_percent, 0.1 * percent, 0.002 * percent);
    EXPECT_NEAR(d.input_to_quads.hausdorff_percent, 0.1 * percent, 0.002 * percent);
    EXPECT_NEAR(d.mean_percent(), 0.1 * percent, 0.002 * percent);
}

TEST(SurfaceDistance, IsTheOffsetOfMovedSpheres) {
    const double offset = 0.2;
    const TriangleMesh fixed = sphere(5);
    const SurfaceDistance d = measure_distance(fixed, moved(fixed, {offset, 0, 0}));
    const double percent = 100 / bounding_box_diagonal(fixed.V);
    EXPECT_NEAR(d.hausdorff_percent(), offset * percent, 0.002 * percent);
    // Mean of | |x + offset e| - 1 | over the sphere, by the substitution r = |x + offset e|.
    const double a = offset;
    const auto primitive = [](double r) { return r * r * r / 3 - r * r / 2; };
    const double mean = (primitive(1 + a) - 2 * primitive(1) + primitive(1 - a)) / (2 * a);
    EXPECT_NEAR(d.quads_to_input.mean_percent, mean * percent, 0.01 * mean * percent);
}

TEST(SurfaceDistance, MeasuresSpheresAgainstInscribedOnes) {
    const TriangleMesh fine = sphere(6);
    const TriangleMesh octahedron = sphere(0);
    const SurfaceDistance d = measure_distance(fine, octahedron);
    const double percent = 100 / bounding_box_diagonal(fine.V);
    EXPECT_NEAR(d.hausdorff_percent(), (1 - 1 / std::sqrt(3.0)) * percent, 0.002 * percent);
    // The octahedron's faces are nearest to the sphere's centre in their middles.
    EXPECT_NEAR(d.quads_to_input.hausdorff_percent, (1 - 1 / std::sqrt(3.0)) * percent,
                0.003 * percent);
    expect_tight(d.quads_to_input);
    expect_tight(d.input_to_quads);
}

/// A surface without order: distances jump from triangle to triangle.
TriangleMesh soup(int count, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    TriangleMesh mesh;
    mesh.V.resize(3 * count, 3);
    mesh.F.resize(count, 3);
    for (int i = 0; i < 3 * count; ++i) {
        for (int k = 0; k < 3; ++k) mesh.V(i, k) = uniform(random);
        mesh.F(i / 3, i % 3) = i;
    }
    return mesh;
}

TEST(SurfaceDistance, HoldsADenseSampleWithinItsBounds) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const TriangleMesh a = soup(20, seed);
        const TriangleMesh b = soup(30, seed + 100);
        const SurfaceDistance d = measure_distance(a, b);
        const ClosestPoints target(b.V, b.F);
        const double percent = 100 / bounding_box_diagonal(a.V);
        const int n = 120;
        double largest = 0;
        double mean = 0;
        double area = 0;
        for (int t = 0; t < a.F.rows(); ++t) {
            const Vector3 p = a.V.row(a.F(t, 0)).transpose();
            const Vector3 u = a.V.row(a.F(t, 1)).transpose() - p;
            const Vector3 v = a.V.row(a.F(t, 2)).transpose() - p;
            double sum = 0;
            int points = 0;
            for (int i = 0; i <= n; ++i) {
                for (int j = 0; i + j <= n; ++j, ++points) {
                    const Vector3 x = p + u * (double(i) / n) + v * (double(j) / n);
                    const double distance = std::sqrt(target.find(x).squared_distance);
                    largest = std::max(largest, distance);
                    sum += distance;
                }
            }
            mean += u.cross(v).norm() * sum / points;
            area += u.cross(v).norm();
        }
        EXPECT_GE(d.input_to_quads.hausdorff_bound_percent, largest * percent);
        EXPECT_GE(d.input_to_quads.hausdorff_percent * 1.01, largest * percent);
        EXPECT_NEAR(d.input_to_quads.mean_percent, mean / area * percent,
                    0.02 * mean / area * percent);
        expect_tight(d.input_to_quads);
    }
}

TEST(SurfaceDistance, DoesNotChangeUnderRigidMotionAndScale) {
    const TriangleMesh a = test::torus(40, 20);
    const TriangleMesh b = test::torus(17, 9);
    const SurfaceDistance before = measure_distance(a, b);
    const Eigen::Matrix3d R =
        Eigen::AngleAxisd(1.1, Vector3(2, -1, 1).normalized()).toRotationMatrix();
    for (const double scale : {1e-6, 1.0, 1e6}) {
        // The bounding box is that of the axes: its diagonal turns with the body.
        TriangleMesh c = a;
        TriangleMesh d = b;
        c.V = scale * a.V * R.transpose();
        d.V = scale * b.V * R.transpose();
        const double turned = bounding_box_diagonal(c.V) / (scale * bounding_box_diagonal(a.V));
        const Eigen::RowVector3d far = scale * Eigen::RowVector3d(100, -300, 200);
        c.V.rowwise() += far;
        d.V.rowwise() += far;
        const SurfaceDistance after = measure_distance(c, d);
        EXPECT_NEAR(after.hausdorff_percent() * turned, before.hausdorff_percent(),
                    0.006 * before.hausdorff_percent());
        EXPECT_NEAR(after.mean_percent() * turned, before.mean_percent(),
                    0.005 * before.mean_percent());
    }
}

TEST(SurfaceDistance, DoesNotDependOnThreadsOrOnTheFramesBefore) {
    const TriangleMesh a = test::torus(60, 30);
    const TriangleMesh b = test::torus(23, 11);
    Context one;
    one.threads = 1;
    const SurfaceDistance alone = measure_distance(a, b, {}, one);
    for (const int threads : {2, 8}) {
        Context context;
        context.threads = threads;
        SurfaceDistanceMeter meter;
        const TriangleMesh larger = scaled(a, 2);
        meter.measure(ClosestPoints(larger.V, larger.F), moved(b, {0.1, 0, 0}), context);
        const SurfaceDistance again = meter.measure(ClosestPoints(a.V, a.F), b, context);
        for (const auto side :
             {&SurfaceDistance::quads_to_input, &SurfaceDistance::input_to_quads}) {
            EXPECT_EQ((alone.*side).hausdorff_percent, (again.*side).hausdorff_percent);
            EXPECT_EQ((alone.*side).hausdorff_bound_percent, (again.*side).hausdorff_bound_percent);
            EXPECT_EQ((alone.*side).mean_percent, (again.*side).mean_percent);
            EXPECT_EQ((alone.*side).samples, (again.*side).samples);
        }
    }
}

TEST(SurfaceDistance, CoarsensItsSamplesRatherThanTakingForEver) {
    DistanceOptions options;
    options.spacing_percent = 0.01;
    options.sample_limit = 10'000;
    const SurfaceDistance d = measure_distance(cube(1), scaled(cube(1), 0.9), options);
    EXPECT_GT(d.quads_to_input.spacing_percent, 0.01);
    EXPECT_LT(d.quads_to_input.samples, 10'000 + options.refinement_limit + 100);
}

TEST(SurfaceDistance, RefusesAnInputWithoutExtent) {
    TriangleMesh point = square(1);
    point.V.setConstant(3);
    EXPECT_THROW(measure_distance(point, square(1)), InputError);
    DistanceOptions options;
    options.spacing_percent = 0;
    EXPECT_THROW(measure_distance(square(1), square(1), options), InputError);
}

}  // namespace
}  // namespace kinequad
