#include "kinequad/mesh/edge_distances.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/shapes.h"

namespace kinequad {
namespace {

TEST(EdgeDistances, AgreeWithRelaxingAllEdgesUntilNothingChanges) {
    for (const TriangleMesh& mesh : {test::square(6), test::torus(12, 7), test::cylinder(9, 5)}) {
        const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
        const IntrinsicMetric metric = metric_of(topology, mesh.V);
        const std::vector<int> sources = {3, topology.vertex_count - 1};
        const std::vector<double> distance = edge_distances(topology, metric, sources);
        std::vector<double> slow(distance.size(), INFINITY);
        for (const int v : sources) slow[static_cast<std::size_t>(v)] = 0;
        for (int round = 0; round < topology.vertex_count; ++round) {
            for (std::size_t e = 0; e < topology.edge_half_edge.size(); ++e) {
                const int h = topology.edge_half_edge[e];
                double& a =
                    slow[static_cast<std::size_t>(topology.origin[static_cast<std::size_t>(h)])];
                double& b = slow[static_cast<std::size_t>(topology.target(h))];
                const double length = metric.edge_length[static_cast<Eigen::Index>(e)];
                a = std::min(a, b + length);
                b = std::min(b, a + length);
            }
        }
        for (std::size_t v = 0; v < slow.size(); ++v) EXPECT_NEAR(distance[v], slow[v], 1e-12);
        const double range = 0.6;
        const std::vector<double> near = edge_distances(topology, metric, sources, range);
        for (std::size_t v = 0; v < slow.size(); ++v) {
            EXPECT_EQ(near[v], distance[v] < range ? distance[v] : INFINITY);
        }
    }
}

}  // namespace
}  // namespace kinequad
