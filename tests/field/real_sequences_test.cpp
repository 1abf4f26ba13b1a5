#include <gtest/gtest.h>

#include <cmath>

#include "field/surfaces.h"
#include "kinequad/deformation/compute_deformation_tensors.h"
#include "kinequad/deformation/compute_mean_metric.h"
#include "kinequad/field/verify_cross_field.h"
#include "kinequad/io/open_sequence.h"
#include "support/data.h"

namespace kinequad {
namespace {

/// Bounds that hold with room to spare for the numbers measured (docs/field.md).
struct Expected {
    const char* name;
    int convex;    ///< singular vertices, default recipe
    int still;     ///< alpha 0, one frame
    int paper;     ///< energy (9) by greedy rounding
    int adjacent;  ///< mesh edges that join two, default recipe
};

class RealField : public testing::TestWithParam<Expected> {};

TEST_P(RealField, HasFewSingularities) {
    KINEQUAD_REQUIRE_DATA();
    const Expected& expected = GetParam();
    const auto frames = open_sequence(
        (test::data_folder() / "sequences" / (std::string(expected.name) + ".obj")).string());
    const Topology topology = build_topology(frames->triangles(), frames->vertex_count());
    const auto run = [&](const IntrinsicMetric& metric, CrossFieldTargetOptions target,
                         DeformationOptions deformation) {
        const double h = std::sqrt(triangle_areas(topology, metric).sum() / 5200);
        deformation.edge_length = target.edge_length = h;
        const DeformationTensors tensors =
            compute_deformation_tensors(*frames, topology, metric, deformation, {});
        const CrossFieldTargets targets =
            compute_cross_field_targets(topology, metric, tensors, target);
        const CrossFieldOptions options{.method = target.method, .edge_length = h};
        const CrossField field = compute_cross_field(topology, metric, targets, options, {});
        const CrossFieldReport report = verify_cross_field(topology, metric, field, options);
        EXPECT_TRUE(report.valid()) << expected.name;
        EXPECT_EQ(report.angleless_vertices, 0) << expected.name;
        EXPECT_EQ(report.large_residuals, 0) << expected.name;
        return std::pair(test::count_singular(field), report.adjacent_singularities);
    };
    const IntrinsicMetric mean = compute_mean_metric(*frames, topology, {});
    const IntrinsicMetric first = metric_of(topology, frames->read_frame(0));
    const auto [convex, adjacent] = run(mean, {}, {});
    EXPECT_LE(convex, expected.convex);
    EXPECT_LE(adjacent, expected.adjacent);
    EXPECT_LE(run(first, {.alpha = 0}, {.only_frame = 0}).first, expected.still);
    const auto paper = run(
        mean, {.method = CrossFieldMethod::paper, .alpha = default_alpha(CrossFieldMethod::paper)},
        {});
    EXPECT_LE(paper.first, expected.paper);
    EXPECT_GT(paper.first, convex);
}

INSTANTIATE_TEST_SUITE_P(SlowSequences, RealField,
                         testing::Values(Expected{"samba", 54, 54, 115, 2},
                                         Expected{"bouncing", 46, 48, 145, 3},
                                         Expected{"horse-gallop", 74, 74, 145, 7},
                                         Expected{"cat-poses", 66, 84, 210, 3}));

}  // namespace
}  // namespace kinequad
