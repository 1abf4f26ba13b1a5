#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "deformation/moves.h"
#include "kinequad/deformation/compute_deformation_tensors.h"
#include "kinequad/io/memory_sequence.h"
#include "support/shapes.h"

namespace kinequad {
namespace {

DeformationTensors bend(const TriangleMesh& mesh, const std::vector<Positions>& frames,
                        double edge_length) {
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    DeformationOptions options;
    options.edge_length = edge_length;
    return compute_deformation_tensors(MemorySequence(mesh.F, frames), topology,
                                       metric_of(topology, mesh.V), options, {});
}

TEST(Curvature, OfACylinderIsItsRadiusAroundIt) {
    // The bend over h is h / r, so that the weight is (h/r)^2 / (1 + (h/r)^2). Triangles are
    // numbered ring by ring; the two rings at each end average over fewer neighbours, which changes
    // nothing here.
    const double radius = 1.5;
    const TriangleMesh mesh = test::cylinder(120, 12, radius, 1);
    const DeformationTensors tensors = bend(mesh, {mesh.V}, 0.5 * radius);
    const double expected = 0.25 / 1.25;
    for (int t = 0; t < mesh.F.rows(); ++t) {
        const Vector3 x =
            (mesh.V.row(mesh.F(t, 1)) - mesh.V.row(mesh.F(t, 0))).normalized().transpose();
        // The direction around the cylinder in the triangle's frame: at -angle from its x-axis.
        const double angle = std::asin(std::clamp(x[2], -1.0, 1.0));
        EXPECT_NEAR(std::abs(tensors.curvature[t] - expected * std::polar(1.0, -4 * angle)), 0,
                    2e-3);
    }
}

TEST(Curvature, IsTheSameOnAnyMeshOfTheCylinder) {
    const TriangleMesh coarse = test::cylinder(40, 6, 1, 1);
    const TriangleMesh fine = test::cylinder(160, 31, 1, 1);
    EXPECT_NEAR(std::abs(bend(coarse, {coarse.V}, 0.3).curvature[100]),
                std::abs(bend(fine, {fine.V}, 0.3).curvature[100]), 1e-3);
}

TEST(Curvature, HasNoDirectionOnAPlaneOrASphere) {
    const TriangleMesh flat = test::square(8);
    EXPECT_EQ(bend(flat, {flat.V}, 1).curvature.cwiseAbs().maxCoeff(), 0);
    const TriangleMesh sphere = test::sphere(4);
    EXPECT_LT(bend(sphere, {sphere.V}, 0.1).curvature.cwiseAbs().mean(), 2e-4);
}

TEST(Curvature, DoesNotDependOnWhereTheFrameStands) {
    const TriangleMesh mesh = test::torus(30, 20);
    const Eigen::VectorXcd here = bend(mesh, {mesh.V}, 0.2).curvature;
    const Eigen::VectorXcd there = bend(mesh, {test::moved_rigidly(mesh.V, 2)}, 0.2).curvature;
    EXPECT_LT((here - there).cwiseAbs().maxCoeff(), 1e-10);
    // Scaled together with the edge length it stays the same too.
    TriangleMesh large = mesh;
    large.V *= 1000;
    const Eigen::VectorXcd scaled = bend(large, {large.V}, 200).curvature;
    EXPECT_LT((here - scaled).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(Curvature, IsAveragedOverTheFrames) {
    const TriangleMesh mesh = test::torus(30, 20);
    const Positions other = test::stretched(mesh.V, 1.6, 0.4);
    const Eigen::VectorXcd both = bend(mesh, {mesh.V, other}, 0.2).curvature;
    const Eigen::VectorXcd mean =
        0.5 * (bend(mesh, {mesh.V}, 0.2).curvature + bend(mesh, {other}, 0.2).curvature);
    EXPECT_LT((both - mean).cwiseAbs().maxCoeff(), 1e-13);
}

}  // namespace
}  // namespace kinequad
