#include "kinequad/mesh/refined_mesh.h"

#include <gtest/gtest.h>

#include <random>

#include "kinequad/mesh/split_along_level.h"
#include "kinequad/mesh/triangle_mesh.h"
#include "support/shapes.h"

namespace kinequad {
namespace {

/// A square cut along a slanted line, which goes through vertices, edges and triangles.
LevelSplit slanted_cut(const TriangleMesh& mesh) {
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    const Eigen::VectorXd height =
        mesh.V.col(0) + 0.37 * mesh.V.col(1) - Eigen::VectorXd::Constant(mesh.V.rows(), 0.61);
    return split_along_level(topology, metric_of(topology, mesh.V), height, 0.1);
}

TEST(RefinementSearch, FindsThePointThatLiesThere) {
    const TriangleMesh mesh = test::square(5);
    const RefinedMesh refined = slanted_cut(mesh).mesh;
    ASSERT_GT(refined.F.rows(), mesh.F.rows());
    const RefinementSearch search(refined);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int t = 0; t < mesh.F.rows(); ++t) {
        for (int trial = 0; trial < 20; ++trial) {
            Vector3 weights(uniform(random), uniform(random), uniform(random));
            weights /= weights.sum();
            const SurfacePoint found = search.find({t, weights});
            EXPECT_GE(found.barycentric.minCoeff(), 0);
            const SurfacePoint back = point_of_input(refined, found);
            EXPECT_EQ(back.triangle, t);
            EXPECT_LT((back.barycentric - weights).norm(), 1e-8);
        }
    }
}

TEST(RefinementSearch, KeepsPointsOfSidesOnThem) {
    const TriangleMesh mesh = test::square(5);
    const RefinedMesh refined = slanted_cut(mesh).mesh;
    const RefinementSearch search(refined);
    for (int t = 0; t < refined.F.rows(); ++t) {
        for (int k = 0; k < 3; ++k) {
            Vector3 weights(0.3, 0.3, 0.3);
            weights[k] = 0;
            weights[(k + 1) % 3] = 0.7;
            const SurfacePoint found = search.find(point_of_input(refined, {t, weights}));
            // On a side of whichever triangle was found, exactly.
            EXPECT_EQ((found.barycentric.array() == 0).count(), 1);
        }
    }
}

}  // namespace
}  // namespace kinequad
