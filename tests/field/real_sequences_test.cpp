// Fields of the recorded sequences, at 5,200 vertices. What docs/field.md tabulates is recorded as
// properties: test_field --gtest_filter='*RealField*' --gtest_output=json:field.json
#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <numbers>
#include <string>

#include "field/surfaces.h"
#include "kinequad/deformation/compute_deformation_tensors.h"
#include "kinequad/deformation/compute_mean_metric.h"
#include "kinequad/deformation/triangle_strain.h"
#include "kinequad/field/verify_cross_field.h"
#include "kinequad/io/open_sequence.h"
#include "support/data.h"

namespace kinequad {
namespace {

/// Bounds a few above the numbers measured (docs/field.md).
struct Expected {
    const char* name;
    int convex;    ///< singular vertices, default recipe
    int still;     ///< alpha 0, one frame
    int paper;     ///< energy (9) by greedy rounding
    int adjacent;  ///< mesh edges that join two, default recipe
};

/// Mean angle between the direction of stretch and the nearest arm of the cross, in degrees,
/// weighted by area and stretch over all frames.
double stretch_alignment(const FrameSource& frames, const Topology& topology,
                         const IntrinsicMetric& metric, const CrossField& field) {
    const auto rest = rest_triangles(topology, metric);
    const Eigen::VectorXd area = triangle_areas(topology, metric);
    double sum = 0;
    double weights = 0;
    for (int frame = 0; frame < frames.frame_count(); ++frame) {
        const Positions V = frames.read_frame(frame);
        for (int t = 0; t < topology.triangle_count; ++t) {
            const int* corner = topology.origin.data() + 3 * t;
            const TriangleStrain strain =
                strain_of(rest[static_cast<std::size_t>(t)], V.data() + 3 * corner[0],
                          V.data() + 3 * corner[1], V.data() + 3 * corner[2]);
            if (!strain.valid()) continue;
            const double weight = area[t] * strain.stretch();
            const double off = std::atan2(strain.y, strain.x) / 2 - field.angle[t];
            sum += weight * std::abs(std::remainder(off, std::numbers::pi / 2));
            weights += weight;
        }
    }
    return sum / weights * 180 / std::numbers::pi;
}

int count_crowded(const Topology& topology, const CrossField& field) {
    int count = 0;
    for (int v = 0; v < topology.vertex_count; ++v) {
        if (!topology.is_boundary_vertex(v) && std::abs(field.index[v]) >= 2) ++count;
    }
    return count;
}

struct Measured {
    int singular = 0;
    int adjacent = 0;
    int crowded = 0;  ///< vertices inside of several quarters
    double alignment = 0;
};

class RealField : public testing::TestWithParam<Expected> {
protected:
    void SetUp() override {
        KINEQUAD_REQUIRE_DATA();
        frames_ = open_sequence(
            (test::data_folder() / "sequences" / (std::string(GetParam().name) + ".obj")).string());
        topology_ = build_topology(frames_->triangles(), frames_->vertex_count());
        mean_ = compute_mean_metric(*frames_, topology_, {});
    }

    Measured measure(const std::string& label, const CrossFieldTargetOptions& options) {
        return measure(label, mean_, options, {});
    }

    Measured measure(const std::string& label, const IntrinsicMetric& metric,
                     CrossFieldTargetOptions target, DeformationOptions deformation) {
        const double h = std::sqrt(triangle_areas(topology_, metric).sum() / 5200);
        deformation.edge_length = target.edge_length = h;
        const DeformationTensors tensors =
            compute_deformation_tensors(*frames_, topology_, metric, deformation, {});
        const CrossFieldTargets targets =
            compute_cross_field_targets(topology_, metric, tensors, target);
        const CrossFieldOptions options{.method = target.method, .edge_length = h};
        const std::clock_t start = std::clock();
        const CrossField field = compute_cross_field(topology_, metric, targets, options, {});
        const std::clock_t end = std::clock();
        const CrossFieldReport report = verify_cross_field(topology_, metric, field, options);
        EXPECT_TRUE(report.valid()) << label;
        EXPECT_EQ(report.angleless_vertices, 0) << label;
        EXPECT_LE(report.large_residuals, 2) << label;
        const Measured measured{test::count_singular(field), report.adjacent_singularities,
                                count_crowded(topology_, field),
                                stretch_alignment(*frames_, topology_, mean_, field)};
        RecordProperty(label + "_singular", measured.singular);
        RecordProperty(label + "_adjacent", measured.adjacent);
        RecordProperty(label + "_crowded", measured.crowded);
        RecordProperty(label + "_energy", std::to_string(field.energy));
        RecordProperty(label + "_degrees", std::to_string(measured.alignment));
        RecordProperty(label + "_cpu_seconds",
                       std::to_string(static_cast<double>(end - start) / CLOCKS_PER_SEC));
        return measured;
    }

    std::unique_ptr<FrameSource> frames_;
    Topology topology_;
    IntrinsicMetric mean_;
};

TEST_P(RealField, HasFewSingularities) {
    const Measured convex = measure("default", {});
    EXPECT_LE(convex.singular, GetParam().convex);
    EXPECT_LE(convex.adjacent, GetParam().adjacent);
    EXPECT_EQ(convex.crowded, 0);
    const IntrinsicMetric reference = metric_of(topology_, frames_->read_frame(0));
    const Measured still = measure("still", reference, {.alpha = 0}, {.only_frame = 0});
    EXPECT_LE(still.singular, GetParam().still);
    EXPECT_EQ(still.crowded, 0);
    const Measured paper = measure(
        "paper", reference,
        {.method = CrossFieldMethod::paper, .alpha = default_alpha(CrossFieldMethod::paper)}, {});
    EXPECT_LE(paper.singular, GetParam().paper);
    EXPECT_GT(paper.singular, convex.singular);
}

TEST_P(RealField, FollowsTheStretchMoreWithMoreAlpha) {
    double last = 45;
    for (const char* alpha : {"0", "0.2", "0.5", "1"}) {
        const Measured measured =
            measure(std::string("alpha_") + alpha, {.alpha = std::stod(alpha)});
        EXPECT_LT(measured.alignment, last);
        EXPECT_EQ(measured.crowded, 0);
        last = measured.alignment;
    }
    EXPECT_LT(last, 19);
}

INSTANTIATE_TEST_SUITE_P(SlowSequences, RealField,
                         testing::Values(Expected{"samba", 60, 56, 105, 2},
                                         Expected{"bouncing", 49, 48, 110, 3},
                                         Expected{"horse-gallop", 85, 69, 125, 7},
                                         Expected{"cat-poses", 75, 94, 260, 4}));

}  // namespace
}  // namespace kinequad
