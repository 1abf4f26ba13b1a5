// The steps on the unit sphere: arithmetic, flips, the conformal map, the reflection, the warp.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <random>

#include "kinequad/symmetry/anti_involution.h"
#include "kinequad/symmetry/cut_handles.h"
#include "kinequad/symmetry/flip_triangulation.h"
#include "kinequad/symmetry/locate_on_sphere.h"
#include "kinequad/symmetry/map_to_sphere.h"
#include "kinequad/symmetry/surface_distances.h"
#include "kinequad/symmetry/warp_to_landmarks.h"
#include "support/shapes.h"
#include "symmetry/symmetric_shapes.h"

namespace kinequad {
namespace {

RealVector3 random_point(std::mt19937& random) {
    std::normal_distribution<double> normal;
    return Vector3(normal(random), normal(random), normal(random)).cast<Real>().normalized();
}

TEST(DoubleDouble, KeepsWhatDoublesLose) {
    const DoubleDouble tiny = 1e-25;
    const DoubleDouble sum = DoubleDouble(1) + tiny;
    EXPECT_DOUBLE_EQ(double(sum - 1), 1e-25);
    EXPECT_NEAR(double((sum * sum - 1) / tiny), 2, 1e-6);
    EXPECT_NEAR(double((sqrt(sum) - 1) / tiny), 0.5, 1e-6);
    EXPECT_NEAR(double((DoubleDouble(1) / sum - 1) / tiny), -1, 1e-6);
    EXPECT_LT(DoubleDouble(1), sum);
    EXPECT_GT(-sum, DoubleDouble(-2));
}

TEST(DoubleDouble, ObeysTheRulesOfArithmetic) {
    rc::check([] {
        const auto number = [] { return *rc::gen::inRange(-1000000, 1000000) / 977.0 + 1e-9; };
        const DoubleDouble a = number();
        const DoubleDouble b = number();
        const DoubleDouble c = DoubleDouble(number()) / 3;
        RC_ASSERT(std::abs(double((a + b) * c - (a * c + b * c))) <= 1e-22);
        RC_ASSERT(std::abs(double(a / c * c - a)) <= 1e-22);
        const DoubleDouble root = sqrt(abs(a * c));
        RC_ASSERT(std::abs(double(root * root - abs(a * c))) <= 1e-18);
    });
}

TEST(FlipTriangulation, EndsDelaunayAndKeepsTheSurface) {
    TriangleMesh mesh = test::bumpy_ellipsoid(3).mesh;
    mesh.V.col(1) *= 3;
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    const IntrinsicMetric metric = kinequad::metric_of(topology, mesh.V);
    FlipTriangulation flipped = make_flip_triangulation(topology, metric);
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(mesh.V.rows());
    EXPECT_GT(flip_to_delaunay(flipped, ones, FlipRule::euclidean), 0);
    EXPECT_EQ(flip_to_delaunay(flipped, ones, FlipRule::euclidean), 0);
    double area = 0;
    Eigen::VectorXd angle_sum = Eigen::VectorXd::Zero(mesh.V.rows());
    for (int t = 0; t < topology.triangle_count; ++t) {
        const auto sides = scaled_sides(flipped, ones, t);
        area += triangle_area(sides);
        const auto angles = corner_angles(sides);
        for (std::size_t k = 0; k < 3; ++k) {
            angle_sum[flipped.origin[3 * static_cast<std::size_t>(t) + k]] += angles[k];
        }
    }
    EXPECT_NEAR(area, triangle_areas(topology, metric).sum(), 1e-10);
    const Eigen::VectorXd defect = angle_defects(topology, metric);
    EXPECT_LT((angle_sum.array() - (2 * std::numbers::pi - defect.array())).abs().maxCoeff(), 1e-9);
    for (int h = 0; h < static_cast<int>(flipped.twin.size()); ++h) {
        const int g = flipped.twin[static_cast<std::size_t>(h)];
        EXPECT_EQ(flipped.twin[static_cast<std::size_t>(g)], h);
        EXPECT_EQ(flipped.origin[static_cast<std::size_t>(g)], flipped.target(h));
    }
}

TEST(CutHandles, CutsATorusAlongItsShortWayRound) {
    const TriangleMesh mesh = test::torus(48, 24);
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    const IntrinsicMetric metric = kinequad::metric_of(topology, mesh.V);
    std::vector<double> side;
    for (const int e : topology.edge) side.push_back(metric.edge_length[e]);
    const CutSurface cut = cut_handles(mesh.F, topology.vertex_count, side, {});
    const Topology open = build_topology(cut.F, cut.vertex_count);
    const SurfaceCounts counts = count_surface(open);
    EXPECT_EQ(counts.components, 1);
    EXPECT_EQ(counts.boundary_loops, 2);
    EXPECT_EQ(counts.euler_characteristic, 0);
    double length = 0;
    const std::vector<int> loop = boundary_loops(open)[0];
    for (const int h : loop) length += side[static_cast<std::size_t>(h)];
    EXPECT_NEAR(length, 2 * std::numbers::pi * 0.4, 0.02);
}

TEST(CutHandles, CutsEveryHandleOfAFigureOfEight) {
    // Two tori joined through a triangle each.
    const TriangleMesh one = test::torus(24, 12);
    const int n = static_cast<int>(one.V.rows());
    Triangles F(2 * one.F.rows() - 2, 3);
    F.topRows(one.F.rows() - 1) = one.F.bottomRows(one.F.rows() - 1);
    F.bottomRows(one.F.rows() - 1) = one.F.bottomRows(one.F.rows() - 1).array() + n;
    // The hole of the second takes the vertices of the first, the other way round.
    const std::array<int, 3> from = {one.F(0, 0) + n, one.F(0, 1) + n, one.F(0, 2) + n};
    const std::array<int, 3> to = {one.F(0, 0), one.F(0, 2), one.F(0, 1)};
    for (Eigen::Index i = 0; i < F.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            if (F.data()[i] == from[k]) F.data()[i] = to[k];
        }
    }
    ASSERT_EQ(count_surface(build_topology(F, 2 * n)).euler_characteristic, -2);
    const std::vector<double> side(static_cast<std::size_t>(F.size()), 1.0);
    const CutSurface cut = cut_handles(F, 2 * n, side, {});
    const SurfaceCounts counts = count_surface(build_topology(cut.F, cut.vertex_count));
    EXPECT_EQ(counts.components, 1);
    EXPECT_EQ(counts.boundary_loops, 4);
    EXPECT_EQ(counts.euler_characteristic, -2);
}

TEST(MapToSphere, MovesASphereByAMoebiusTransformation) {
    // Chords of a triangulated sphere are discretely conformal to it; so what the map does to it
    // must keep every length cross-ratio.
    TriangleMesh mesh = test::sphere(3);
    const RealVector3 axis = Vector3(0.36, 0.48, 0.8).cast<Real>();
    SpherePoints moved = mesh.V.cast<Real>();
    boost_points(moved, axis, Real(0.4));
    mesh.V = moved.cast<double>();
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    const IntrinsicMetric metric = kinequad::metric_of(topology, mesh.V);
    const auto distances = tabulate_distances(topology, metric, {0}, 8, 0);
    const SphereMap map = map_to_sphere(topology, metric, distances.mean, {});
    EXPECT_TRUE(map.is_uniform);
    EXPECT_EQ(map.reversed_triangles, 0);
    EXPECT_LT((map.points.cast<double>().rowwise().norm().array() - 1).abs().maxCoeff(), 1e-14);
    const auto cross_ratio = [&](const Positions& V, int h) {
        const auto distance = [&](int a, int b) { return (V.row(a) - V.row(b)).norm(); };
        const int g = topology.twin[static_cast<std::size_t>(h)];
        const int a = topology.origin[static_cast<std::size_t>(h)];
        const int b = topology.target(h);
        const int c = topology.target(Topology::next(h));
        const int d = topology.target(Topology::next(g));
        return distance(a, c) * distance(b, d) / distance(c, b) / distance(d, a);
    };
    const Positions image = map.points.cast<double>();
    for (int h = 0; h < 3 * topology.triangle_count; ++h) {
        EXPECT_NEAR(cross_ratio(image, h) / cross_ratio(mesh.V, h), 1, 1e-6);
    }
}

TEST(AntiInvolution, IsFoundFromPairsAndSquaresToTheIdentity) {
    rc::check([] {
        std::mt19937 random(*rc::gen::arbitrary<unsigned>());
        AntiInvolution truth;
        const Vector3 direction = random_point(random).cast<double>();
        truth.n0 = std::uniform_real_distribution<double>(-1, 1)(random);
        truth.s = std::sqrt(1 + truth.n0 * truth.n0) * direction;
        SpherePoints points(9, 3);
        SphereLandmarks landmarks;
        for (int i = 0; i < 4; ++i) {
            const RealVector3 p = random_point(random);
            points.row(2 * i) = p.transpose();
            points.row(2 * i + 1) = truth.apply(p).transpose();
            RC_ASSERT(double((truth.apply(truth.apply(p)) - p).norm()) < 1e-12);
            RC_ASSERT(std::abs(double(truth.apply(p).norm()) - 1) < 1e-12);
            landmarks.pairs.push_back({2 * i, 2 * i + 1});
        }
        points.row(8) = random_point(random).transpose();
        const AntiInvolution fit = fit_anti_involution(points, landmarks);
        RC_ASSERT(fit.is_reflection);
        RC_ASSERT(fit.rms < 1e-6);
        // After the move the reflection is a plain mirror.
        SpherePoints moved = points;
        const RealVector3 axis = move_to_great_circle(moved, fit);
        for (const auto& [a, b] : landmarks.pairs) {
            const RealVector3 image = mirrored(moved.row(a).transpose(), axis);
            RC_ASSERT(double((image - moved.row(b).transpose()).norm()) < 1e-6);
        }
    });
}

TEST(WarpToLandmarks, MakesThemSymmetricAndLeavesSymmetricOnes) {
    std::mt19937 random(3);
    const RealVector3 axis = random_point(random);
    SpherePoints points(40, 3);
    SphereLandmarks landmarks;
    for (int i = 0; i < 40; ++i) points.row(i) = random_point(random).transpose();
    for (int i = 0; i < 5; ++i) {
        const RealVector3 near =
            (mirrored(points.row(2 * i).transpose(), axis) + Real(0.1) * random_point(random))
                .normalized();
        points.row(2 * i + 1) = near.transpose();
        landmarks.pairs.push_back({2 * i, 2 * i + 1});
    }
    landmarks.stationary = {20, 21};
    const SpherePoints warped = warp_to_landmarks(points, landmarks, axis, {});
    for (const auto& [a, b] : landmarks.pairs) {
        const RealVector3 image = mirrored(warped.row(a).transpose(), axis);
        EXPECT_LT(double((image - warped.row(b).transpose()).norm()), 1e-25);
    }
    for (const int v : landmarks.stationary) {
        EXPECT_LT(std::abs(double(warped.row(v).dot(axis.transpose()))), 1e-25);
    }
    const SpherePoints again = warp_to_landmarks(warped, landmarks, axis, {});
    EXPECT_LT((again - warped).cast<double>().cwiseAbs().maxCoeff(), 1e-25);
}

TEST(LocateOnSphere, FindsTheTriangleFromAnywhere) {
    const TriangleMesh mesh = test::sphere(3);
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    const SpherePoints points = mesh.V.cast<Real>();
    std::mt19937 random(5);
    for (int i = 0; i < 200; ++i) {
        const RealVector3 query = random_point(random);
        const SphereLocation found =
            locate_on_sphere(topology, points, query, (37 * i) % topology.triangle_count);
        EXPECT_TRUE(found.is_inside);
        const Vector3 there = position_of(found.point, mesh.V, mesh.F).normalized();
        EXPECT_LT((there - query.cast<double>()).norm(), 1e-12);
    }
}

}  // namespace
}  // namespace kinequad
