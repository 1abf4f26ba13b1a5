#include "kinequad/deformation/compute_mean_metric.h"

#include <gtest/gtest.h>

#include "deformation/moves.h"
#include "kinequad/core/error.h"
#include "kinequad/io/memory_sequence.h"
#include "support/shapes.h"

namespace kinequad {
namespace {

using test::moved_rigidly;

TEST(MeanMetric, OfRigidMotionsIsTheMetric) {
    const TriangleMesh mesh = test::sphere(3);
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    const MemorySequence frames(mesh.F,
                                {mesh.V, moved_rigidly(mesh.V, 0.4), moved_rigidly(mesh.V, 2.2)});
    const Eigen::VectorXd expected = metric_of(topology, mesh.V).edge_length;
    const Eigen::VectorXd mean = compute_mean_metric(frames, topology, {}).edge_length;
    EXPECT_LT((mean - expected).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(MeanMetric, AveragesLengthsNotPositions) {
    // Two frames that mirror each other meet in a point as positions, but not as lengths.
    const TriangleMesh mesh = test::tetrahedron();
    const Topology topology = build_topology(mesh.F, 4);
    const MemorySequence frames(mesh.F, {mesh.V, 3 * mesh.V, -2 * mesh.V});
    const Eigen::VectorXd mean = compute_mean_metric(frames, topology, {}).edge_length;
    EXPECT_LT((mean - 2 * metric_of(topology, mesh.V).edge_length).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(MeanMetric, NamesAFrameThatIsASinglePoint) {
    const TriangleMesh mesh = test::tetrahedron();
    const MemorySequence frames(mesh.F, {mesh.V, 0 * mesh.V}, std::nullopt, "some/frames");
    try {
        compute_mean_metric(frames, build_topology(mesh.F, 4), {});
        ADD_FAILURE() << "was accepted";
    } catch (const InputError& error) {
        EXPECT_EQ(error.fault(), InputFault::mesh);
        EXPECT_NE(std::string(error.what()).find("some/frames: in frame 1"), std::string::npos)
            << error.what();
    }
}

TEST(MeanMetric, SameBytesOnAnyNumberOfThreads) {
    const TriangleMesh mesh = test::torus(90, 70);
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    const MemorySequence frames(mesh.F, {mesh.V, 1.1 * mesh.V, moved_rigidly(mesh.V, 1)});
    Context context;
    context.threads = 1;
    const Eigen::VectorXd one = compute_mean_metric(frames, topology, context).edge_length;
    for (const int threads : {2, 8}) {
        context.threads = threads;
        EXPECT_EQ(compute_mean_metric(frames, topology, context).edge_length, one);
    }
}

TEST(MeanMetric, StopsWhenAsked) {
    const TriangleMesh mesh = test::tetrahedron();
    const std::atomic<bool> cancel = true;
    Context context;
    context.cancel = &cancel;
    EXPECT_THROW(
        compute_mean_metric(MemorySequence(mesh.F, {mesh.V}), build_topology(mesh.F, 4), context),
        Cancelled);
}

}  // namespace
}  // namespace kinequad
