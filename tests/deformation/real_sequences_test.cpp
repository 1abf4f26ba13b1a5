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
    double strength;   ///< mean of tau^2
    double coherence;  ///< mean modulus of the shear over mean tau^2
};

class RealDeformation : public testing::TestWithParam<Expected> {};

TEST_P(RealDeformation, HasTheMeasuredStrength) {
    KINEQUAD_REQUIRE_DATA();
    const Expected& expected = GetParam();
    const auto frames = open_sequence(
        (test::data_folder() / "sequences" / (std::string(expected.name) + ".obj")).string());
    const Topology topology = build_topology(frames->triangles(), frames->vertex_count());
    const IntrinsicMetric metric = compute_mean_metric(*frames, topology, {});
    const DeformationTensors tensors =
        compute_deformation_tensors(*frames, topology, metric, {}, {});
    EXPECT_EQ(tensors.frame_count, expected.frames);
    EXPECT_NEAR(tensors.shear_strength.mean(), expected.strength, 1e-3);
    EXPECT_NEAR(tensors.shear.cwiseAbs().mean() / tensors.shear_strength.mean(), expected.coherence,
                0.01);
    // The mean of powers is no longer than the mean of their moduli.
    EXPECT_LE((tensors.shear.cwiseAbs() - tensors.shear_strength).maxCoeff(), 1e-15);
    EXPECT_LE((tensors.stretch_direction_sum.cwiseAbs() - tensors.stretch_sum).maxCoeff(), 1e-10);
    EXPECT_LE(tensors.shear_strength.maxCoeff(), 1);
}

INSTANTIATE_TEST_SUITE_P(Sequences, RealDeformation,
                         testing::Values(Expected{"samba", 175, 0.0472, 0.566},
                                         Expected{"bouncing", 175, 0.0459, 0.412},
                                         Expected{"horse-gallop", 48, 0.0304, 0.826},
                                         Expected{"cat-poses", 9, 0.0771, 0.741}));

}  // namespace
}  // namespace kinequad
