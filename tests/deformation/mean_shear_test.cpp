#include "kinequad/deformation/mean_shear.h"

#include <gtest/gtest.h>

#include "kinequad/io/memory_sequence.h"
#include "support/shapes.h"

namespace kinequad {
namespace {

TEST(MeanShear, OfAStretchIsKnown) {
    const TriangleMesh mesh = test::square(4);
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    const IntrinsicMetric rest = metric_of(topology, mesh.V);
    Positions V = 3 * mesh.V;
    EXPECT_NEAR(mean_shear(topology, rest, metric_of(topology, V)), 0, 1e-7);
    V.col(0) *= 2;
    // Stretches 6 and 3: (36 - 9) / (36 + 9).
    EXPECT_NEAR(mean_shear(topology, rest, metric_of(topology, V)), 0.6, 1e-12);
    EXPECT_NEAR(mean_shear(topology, metric_of(topology, V), rest), 0.6, 1e-12);
}

TEST(MeanShear, ComparesTheMeanWithTheReference) {
    const TriangleMesh mesh = test::square(4);
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    Positions V = mesh.V;
    V.col(0) *= 2;
    const MemorySequence frames(mesh.F, {mesh.V, V, V});
    const IntrinsicMetric reference = metric_of(topology, mesh.V);
    const IntrinsicMetric other = metric_of(topology, V);
    const MetricComparison comparison =
        compare_metrics(frames, topology, other, reference, Context{});
    // The reference fits one frame of three, the other metric two.
    EXPECT_NEAR(comparison.gain, 0.6 / 3, 1e-9);
    EXPECT_NEAR(comparison.cost, 0.6, 1e-12);
}

}  // namespace
}  // namespace kinequad
