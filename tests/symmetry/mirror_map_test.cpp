#include <gtest/gtest.h>

#include <numbers>

#include "kinequad/core/error.h"
#include "kinequad/io/memory_sequence.h"
#include "kinequad/symmetry/compute_mirror_map.h"
#include "kinequad/symmetry/find_mirror_plane.h"
#include "kinequad/symmetry/match_parts.h"
#include "kinequad/symmetry/stationary_curve.h"
#include "kinequad/symmetry/verify_symmetry_map.h"
#include "kinequad/synth/synthesize_creature.h"
#include "symmetry/symmetric_shapes.h"

namespace kinequad {
namespace {

const Eigen::Matrix3d turn = (Eigen::AngleAxisd(0.8, Vector3(1, 2, -1).normalized()) *
                              Eigen::AngleAxisd(2.1, Vector3::UnitY()))
                                 .toRotationMatrix();

Positions moved(const Positions& V) {
    return (V * turn.transpose()).rowwise() + Eigen::RowVector3d(3, -7, 2);
}

TEST(MirrorPlane, IsFoundInAnyPosition) {
    const test::SymmetricShape shape = test::bumpy_ellipsoid(4);
    const TriangleMesh mesh{1e3 * moved(shape.mesh.V), shape.mesh.F};
    const MirrorPlane plane = find_mirror_plane(mesh, {});
    const Vector3 expected = turn.col(0);
    EXPECT_GT(std::abs(plane.normal.dot(expected)), 1 - 1e-8);
    EXPECT_NEAR(plane.offset, 1e3 * plane.normal.dot(Vector3(3, -7, 2)), 0.1);
    EXPECT_LT(plane.residual_percent, 0.01);
}

TEST(MirrorPlane, OfAFlatSheetIsNotTheSheetsOwn) {
    // A trapezoid: it mirrors in one direction, but for that across itself.
    constexpr int n = 8;
    TriangleMesh sheet;
    sheet.V.resize((n + 1) * (n + 1), 3);
    sheet.F.resize(2 * n * n, 3);
    for (int v = 0; v < sheet.V.rows(); ++v) {
        const double x = 2.0 * (v % (n + 1)) / n - 1;
        const double y = static_cast<double>(v / (n + 1)) / n;
        sheet.V.row(v) << x * (2 - y), 1.5 * y, 0;
    }
    for (int q = 0; q < n * n; ++q) {
        const int v = q / n * (n + 1) + q % n;
        sheet.F.row(2 * q) << v, v + 1, v + n + 2;
        sheet.F.row(2 * q + 1) << v, v + n + 2, v + n + 1;
    }
    for (const Positions& V : {sheet.V, moved(sheet.V)}) {
        const TriangleMesh mesh{V, sheet.F};
        const MirrorPlane plane = find_mirror_plane(mesh, {});
        const Vector3 across = (V.row(n) - V.row(0)).normalized().transpose();
        EXPECT_GT(std::abs(plane.normal.dot(across)), 1 - 1e-3);
    }
}

TEST(MirrorPlane, OfAShapeWithoutOneHasAResidual) {
    TriangleMesh mesh = test::sphere(3);
    for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
        const Vector3 p = mesh.V.row(v).transpose();
        mesh.V.row(v) *= 1 + 0.3 * p[0] * p[1] * p[2] + 0.2 * p[0] * p[0] * p[1] +
                         0.1 * p[2] * p[2] * p[0] + 0.1 * p[2];
    }
    EXPECT_GT(find_mirror_plane(mesh, {}).residual_percent, 0.3);
}

TEST(SymmetricPose, IsTheRestShapeOfAWalkingCreature) {
    const auto creature = synthesize_creature("biped", {3000, 16}, {});
    const auto pose = find_symmetric_pose(*creature, 0.1, {});
    ASSERT_TRUE(pose.has_value());
    EXPECT_EQ(pose->frame, -1);
    std::vector<Positions> frames;
    for (int i = 0; i < 4; ++i) frames.push_back(creature->read_frame(i));
    const MemorySequence walk(creature->triangles(), frames);
    EXPECT_FALSE(find_symmetric_pose(walk, 0.1, {}).has_value());
}

TEST(MirrorMap, IsTheMirrorOfACreature) {
    const auto creature = synthesize_creature("quadruped", {4000, 2}, {});
    const TriangleMesh mesh{creature->read_rest_shape(), creature->triangles()};
    const SymmetryMap map =
        compute_mirror_map(mesh, find_mirror_plane(mesh, {}), test::metric_of(mesh), {});
    EXPECT_EQ(map.method, "mirror plane");
    EXPECT_LT(test::map_errors(mesh, map.vertex_image, creature->mirror()).maxCoeff(), 0.02);
    EXPECT_LT(test::transport_error(mesh, map.centre_image, map.transport, creature->mirror()),
              0.02);
    EXPECT_EQ(map.quality.reversed_triangles, 0);
    const SymmetryReport report = verify_symmetry_map(mesh, map);
    EXPECT_EQ(report.stationary_loops, 1);
    EXPECT_LT(report.involution_mean_percent, 0.02);
}

TEST(MirrorMap, OfASymmetricMeshGivesVerticesWhateverTheRounding) {
    const test::SymmetricShape shape = test::bumpy_ellipsoid(4);
    const auto images = [&](const Positions& V, const MirrorPlane& plane) {
        const TriangleMesh mesh{V, shape.mesh.F};
        return compute_mirror_map(mesh, plane, test::metric_of(mesh), {}).vertex_image;
    };
    const std::vector<SurfacePoint> exact = images(shape.mesh.V, {Vector3::UnitX(), 0, 0});
    const Vector3 normal = turn.col(0);
    const std::vector<SurfacePoint> rounded =
        images(moved(shape.mesh.V), {normal, normal.dot(Vector3(3, -7, 2)), 0});
    for (std::size_t v = 0; v < exact.size(); ++v) {
        EXPECT_EQ(exact[v].barycentric.maxCoeff(), 1);
        EXPECT_EQ(rounded[v], exact[v]);
    }
}

TEST(MirrorMap, TakesSurfacesWithHandles) {
    const TriangleMesh mesh = test::torus(40, 20);
    const SymmetryMap map =
        compute_mirror_map(mesh, {Vector3::UnitX(), 0, 0}, test::metric_of(mesh), {});
    EXPECT_LT(test::map_errors(mesh, map.vertex_image, test::mirror_in_x(mesh.V)).maxCoeff(), 1e-9);
    EXPECT_EQ(verify_symmetry_map(mesh, map).stationary_loops, 2);
}

TEST(MirrorMap, MapsComponentsToTheirPartners) {
    // Two spheres that mirror each other inside each other's closest reach, one mapped to itself.
    const TriangleMesh one = test::sphere(3);
    const Eigen::Index n = one.V.rows();
    TriangleMesh mesh;
    mesh.V.resize(3 * n, 3);
    mesh.F.resize(3 * one.F.rows(), 3);
    for (Eigen::Index i = 0; i < 3; ++i) {
        mesh.V.middleRows(i * n, n) =
            (0.99 * one.V).rowwise() + Eigen::RowVector3d(static_cast<double>(i - 1) * 2, 0, 0);
        mesh.F.middleRows(i * one.F.rows(), one.F.rows()) = one.F.array() + static_cast<int>(i * n);
    }
    const SymmetryMap map =
        compute_mirror_map(mesh, {Vector3::UnitX(), 0, 0}, test::metric_of(mesh), {});
    for (Eigen::Index v = 0; v < 3 * n; ++v) {
        const Eigen::Index part =
            map.vertex_image[static_cast<std::size_t>(v)].triangle / one.F.rows();
        EXPECT_EQ(part, 2 - v / n);
    }
    EXPECT_LT(test::map_errors(mesh, map.vertex_image, test::mirror_in_x(mesh.V)).maxCoeff(), 1e-9);
}

/// A body, a limb and its mirror image, which is turned and shifted away from where it would
/// mirror, so that no plane mirrors all of them.
test::SymmetricShape body_with_a_moved_limb() {
    test::SymmetricShape body = test::bumpy_ellipsoid(3);
    TriangleMesh limb = test::sphere(3);
    for (Eigen::Index v = 0; v < limb.V.rows(); ++v) {
        const Vector3 p = limb.V.row(v).transpose();
        const double bump = 0.3 * std::exp(-6 * (p - Vector3(0.6, 0.7, 0.4)).squaredNorm());
        limb.V.row(v) = (0.3 + bump) * Vector3(2 * p[0] + 0.3 * p[1], p[1], 0.8 * p[2]).transpose();
    }
    const Eigen::Matrix3d turned =
        Eigen::AngleAxisd(0.06, Vector3(1, 2, 1).normalized()).toRotationMatrix();
    const Eigen::Index n = body.mesh.V.rows();
    const Eigen::Index k = limb.V.rows();
    test::SymmetricShape shape;
    shape.mesh.V.resize(n + 2 * k, 3);
    shape.mesh.V.topRows(n) = body.mesh.V;
    for (Eigen::Index v = 0; v < k; ++v) {
        const Vector3 p = limb.V.row(v).transpose() + Vector3(2, 0.2, 0);
        const Vector3 mirrored = turned * Vector3(-p[0], p[1], p[2]) + Vector3(0.05, 0.15, 0.1);
        shape.mesh.V.row(n + v) = p.transpose();
        shape.mesh.V.row(n + k + v) = mirrored.transpose();
    }
    Triangles reversed = limb.F;
    reversed.col(1) = limb.F.col(2);
    reversed.col(2) = limb.F.col(1);
    shape.mesh.F.resize(body.mesh.F.rows() + 2 * limb.F.rows(), 3);
    shape.mesh.F << body.mesh.F, limb.F.array() + static_cast<int>(n),
        reversed.array() + static_cast<int>(n + k);
    shape.mirror = body.mirror;
    for (const Eigen::Index other : {n + k, n}) {
        for (Eigen::Index v = 0; v < k; ++v) shape.mirror.push_back(static_cast<int>(other + v));
    }
    return shape;
}

TEST(MirrorMap, MirrorsPartsOneByOneWhereThePoseIsNotSymmetric) {
    const test::SymmetricShape shape = body_with_a_moved_limb();
    const TriangleMesh& mesh = shape.mesh;
    const MirrorPlane plane = find_mirror_plane(mesh, {});
    EXPECT_GT(plane.residual_percent, 3 * symmetric_pose_percent);
    const SymmetryMap map = compute_mirror_map(mesh, plane, test::metric_of(mesh), {});
    EXPECT_LT(test::map_errors(mesh, map.vertex_image, shape.mirror).maxCoeff(), 0.1);
    EXPECT_EQ(map.quality.reversed_triangles, 0);
    EXPECT_LT(map.quality.involution_max_percent, 0.05);
    // The line runs around the body; each limb is on one side of it.
    EXPECT_EQ(map.stationary.size(), 1U);
    const Eigen::Index body = test::sphere(3).V.rows();
    const Eigen::Index limb = (mesh.V.rows() - body) / 2;
    const double sign = map.height[body] > 0 ? 1 : -1;
    EXPECT_GT((sign * map.height.segment(body, limb)).minCoeff(), 0);
    EXPECT_LT((sign * map.height.tail(limb)).maxCoeff(), 0);
}

TEST(MatchParts, PairsThoseThatAreLeftByPlace) {
    // Four ellipsoids, none of which falls on another when mirrored in x = 0. Each is symmetric in
    // itself, so that it could be laid onto its partner in several ways.
    const TriangleMesh one = test::sphere(2);
    const std::vector<Vector3> place = {{-3, 0.5, 0}, {3, -0.5, 0}, {-2.9, 4, 0}, {3.2, 3.3, 0}};
    const Eigen::Index n = one.V.rows();
    TriangleMesh mesh;
    mesh.V.resize(4 * n, 3);
    mesh.F.resize(4 * one.F.rows(), 3);
    std::vector<std::vector<int>> parts(4);
    for (Eigen::Index i = 0; i < 4; ++i) {
        const std::size_t part = static_cast<std::size_t>(i);
        mesh.V.middleRows(i * n, n) =
            (one.V * Vector3(0.5, 0.3, 0.2).asDiagonal()).rowwise() + place[part].transpose();
        mesh.F.middleRows(i * one.F.rows(), one.F.rows()) = one.F.array() + static_cast<int>(i * n);
        for (Eigen::Index t = 0; t < one.F.rows(); ++t) {
            parts[part].push_back(static_cast<int>(i * one.F.rows() + t));
        }
    }
    const std::vector<PartMatch> matches =
        match_parts(mesh, parts, {Vector3::UnitX(), 0, 5 * symmetric_pose_percent}, {});
    const std::vector<int> partner = {1, 0, 3, 2};
    for (std::size_t i = 0; i < 4; ++i) {
        ASSERT_EQ(matches[i].partner, partner[i]);
        const Vector3 there = place[static_cast<std::size_t>(partner[i])];
        // The way that turns them least is meant.
        for (const Vector3& d : {Vector3(0.5, 0, 0), Vector3(0, 0.3, 0), Vector3(0, 0, 0.2)}) {
            const Vector3 mirrored = there + Vector3(-d[0], d[1], d[2]);
            EXPECT_LT((matches[i].motion(place[i] + d) - mirrored).norm(), 1e-3);
        }
        EXPECT_NEAR(matches[i].motion.linear.determinant(), -1, 1e-9);
        // Back again is where it came from.
        const MirrorMotion& back = matches[static_cast<std::size_t>(partner[i])].motion;
        EXPECT_LT((back(matches[i].motion(Vector3(1, 2, 3))) - Vector3(1, 2, 3)).norm(), 1e-9);
    }
}

TEST(MatchParts, LeavesAPartWithoutAPartnerToItself) {
    // A body across the plane and something on one hip.
    const test::SymmetricShape body = test::bumpy_ellipsoid(3);
    const TriangleMesh ball = test::sphere(2);
    const Eigen::Index n = body.mesh.V.rows();
    TriangleMesh mesh;
    mesh.V.resize(n + ball.V.rows(), 3);
    mesh.V << body.mesh.V,
        (ball.V * Vector3(0.1, 0.6, 0.05).asDiagonal()).rowwise() + Eigen::RowVector3d(2, 0.3, 0.1);
    mesh.F.resize(body.mesh.F.rows() + ball.F.rows(), 3);
    mesh.F << body.mesh.F, ball.F.array() + static_cast<int>(n);
    std::vector<std::vector<int>> parts(2);
    for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
        parts[t < body.mesh.F.rows() ? 0 : 1].push_back(static_cast<int>(t));
    }
    const std::vector<PartMatch> matches =
        match_parts(mesh, parts, {Vector3::UnitX(), 0, 5 * symmetric_pose_percent}, {});
    EXPECT_EQ(matches[0].partner, 0);
    EXPECT_EQ(matches[1].partner, 1);
    EXPECT_LT((matches[0].motion(Vector3(1, 2, 3)) - Vector3(-1, 2, 3)).norm(), 1e-2);
    EXPECT_LT((matches[1].motion(Vector3(2.1, 0.5, 0.1)) - Vector3(1.9, 0.5, 0.1)).norm(), 1e-2);
}

TEST(StationaryCurve, KeepsTheLineOfASmallPart) {
    // A button beside a body a hundred times as large, both across the plane.
    const TriangleMesh ball = test::sphere(3);
    const Eigen::Index n = ball.V.rows();
    TriangleMesh mesh;
    mesh.V.resize(2 * n, 3);
    mesh.V << ball.V, (0.01 * ball.V).rowwise() + Eigen::RowVector3d(0, 1.1, 0);
    mesh.F.resize(2 * ball.F.rows(), 3);
    mesh.F << ball.F, ball.F.array() + static_cast<int>(n);
    const Topology topology = build_topology(mesh.F, static_cast<int>(2 * n));
    const Eigen::VectorXd height = mesh.V.col(0).array() + 1e-4;
    const StationaryCurve curve = trace_stationary_curve(
        topology, kinequad::metric_of(topology, mesh.V), height, topology.triangle_count, 0.02);
    EXPECT_EQ(curve.polylines.size(), 2U);
}

TEST(MirrorMap, IsRefusedWhereThePlaneMissesTheSurface) {
    const TriangleMesh mesh = test::sphere(2);
    EXPECT_THROW(compute_mirror_map(mesh, {Vector3::UnitX(), 5, 0}, test::metric_of(mesh), {}),
                 InputError);
}

Eigen::VectorXd height_of(const TriangleMesh& mesh, const Vector3& normal) {
    return mesh.V * normal;
}

TEST(StationaryCurve, IsTheEquatorOfASphere) {
    const TriangleMesh mesh = test::sphere(4);
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    const IntrinsicMetric metric = kinequad::metric_of(topology, mesh.V);
    const Vector3 normal = Vector3(0.3, -0.5, 0.7).normalized();
    const StationaryCurve curve = trace_stationary_curve(topology, metric, height_of(mesh, normal),
                                                         topology.triangle_count, 0.05);
    ASSERT_EQ(curve.polylines.size(), 1U);
    const auto& line = curve.polylines[0];
    double length = 0;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const Vector3 a = position_of(line[i], mesh.V, mesh.F);
        const Vector3 b = position_of(line[i + 1], mesh.V, mesh.F);
        length += (b - a).norm();
        // With the positive side on its left, the curve turns counter-clockwise about the normal.
        EXPECT_GE(a.cross(b).dot(normal), -1e-9);
        // The direction of the triangle, in space, is along the curve.
        const StationaryDirection& d = curve.directions[i];
        ASSERT_EQ(d.triangle, line[i].triangle);
        const Vector3 origin = mesh.V.row(mesh.F(d.triangle, 0)).transpose();
        const Vector3 x = (mesh.V.row(mesh.F(d.triangle, 1)).transpose() - origin).normalized();
        const Vector3 y = (a + b).normalized().cross(x);
        const Vector3 along = std::cos(d.angle) * x + std::sin(d.angle) * y;
        EXPECT_GT(std::abs(along.dot(normal.cross(a + b).normalized())), 0.97);
    }
    EXPECT_NEAR(length, 2 * std::numbers::pi, 0.02);
}

TEST(StationaryCurve, EndsOnTheBoundaryAndDropsSpecks) {
    const TriangleMesh mesh = test::cylinder(80, 40);
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    const IntrinsicMetric metric = kinequad::metric_of(topology, mesh.V);
    const double low = mesh.V.col(2).minCoeff();
    const double high = mesh.V.col(2).maxCoeff();
    const double middle = (low + high) / 2;
    Eigen::VectorXd height = height_of(mesh, Vector3(0.9, 0.3, 0.02));
    Eigen::Index far = 0;
    (mesh.V * Vector3(1, 0.2, 0) - (mesh.V.col(2).array() - middle).abs().matrix()).maxCoeff(&far);
    height[far] *= -1;  // a speck on the wrong side
    const StationaryCurve curve =
        trace_stationary_curve(topology, metric, height, topology.triangle_count, 0.3);
    EXPECT_EQ(curve.dropped_loops, 1);
    EXPECT_EQ(curve.polylines.size(), 2U);
    EXPECT_GT(curve.height[far], 0);
    for (const auto& line : curve.polylines) {
        for (const SurfacePoint& end : {line.front(), line.back()}) {
            const double z = position_of(end, mesh.V, mesh.F)[2];
            EXPECT_LT(std::min(z - low, high - z), 1e-9);
        }
    }
}

}  // namespace
}  // namespace kinequad
