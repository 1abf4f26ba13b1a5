#include "kinequad/mesh/feature_edges.h"

#include <gtest/gtest.h>

#include "support/shapes.h"

namespace kinequad {
namespace {

TEST(FeatureEdges, AreTheEdgesOfACube) {
    const int n = 4;
    const TriangleMesh cube = test::cube(n);
    const Topology topology = build_topology(cube.F, static_cast<int>(cube.V.rows()));
    EXPECT_EQ(find_feature_edges(topology, cube.V, 89).size(), 12U * n);
    EXPECT_TRUE(find_feature_edges(topology, cube.V, 91).empty());
}

TEST(FeatureEdges, DoNotChangeWithScale) {
    const TriangleMesh ball = test::sphere(2);
    const Topology topology = build_topology(ball.F, static_cast<int>(ball.V.rows()));
    const std::vector<int> features = find_feature_edges(topology, ball.V, 14);
    EXPECT_FALSE(features.empty());
    EXPECT_EQ(find_feature_edges(topology, 1e-9 * ball.V, 14), features);
    EXPECT_EQ(find_feature_edges(topology, 1e9 * ball.V, 14), features);
}

}  // namespace
}  // namespace kinequad
