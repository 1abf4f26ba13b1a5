#include <gtest/gtest.h>

#include "kinequad/deformation/compute_deformation_tensors.h"
#include "kinequad/deformation/compute_mean_metric.h"
#include "kinequad/io/open_sequence.h"
#include "support/data.h"

namespace kinequad {
namespace {

struct Expected {
    const char* name;
    int frames;
    double stretch;    ///< mean over triangles and frames
    double coherence;  ///< sum of the moduli of `stretch_direction_sum` over that of `stretch_sum`
};

class RealDeformation : public testing::TestWithParam<Expected> {};

TEST_P(RealDeformation, HasTheMeasuredStretch) {
    KINEQUAD_REQUIRE_DATA();
    const Expected& expected = GetParam();
    const auto frames = open_sequence(
        (test::data_folder() / "sequences" / (std::string(expected.name) + ".obj")).string());
    const Topology topology = build_topology(frames->triangles(), frames->vertex_count());
    const IntrinsicMetric metric = compute_mean_metric(*frames, topology, {});
    const DeformationTensors tensors =
        compute_deformation_tensors(*frames, topology, metric, {}, {});
    EXPECT_EQ(tensors.frame_count, expected.frames);
    EXPECT_NEAR(tensors.stretch_sum.mean() / expected.frames, expected.stretch, 1e-3);
    EXPECT_NEAR(tensors.stretch_direction_sum.cwiseAbs().sum() / tensors.stretch_sum.sum(),
                expected.coherence, 0.01);
    // The mean of powers is no longer than the mean of their moduli.
    EXPECT_LE((tensors.stretch_direction_sum.cwiseAbs() - tensors.stretch_sum).maxCoeff(), 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Sequences, RealDeformation,
                         testing::Values(Expected{"samba", 175, 0.2010, 0.501},
                                         Expected{"bouncing", 175, 0.2082, 0.342},
                                         Expected{"horse-gallop", 48, 0.1152, 0.813},
                                         Expected{"cat-poses", 9, 0.2909, 0.741}));

}  // namespace
}  // namespace kinequad
