#include "kinequad/pipeline/options.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "kinequad/core/error.h"

namespace kinequad {
namespace {

/// Expects that `options` are refused with a message that names `option`.
void expect_refused(const Options& options, const std::string& option) {
    try {
        resolve_options(options, 10, false, false);
        ADD_FAILURE() << option << " was accepted";
    } catch (const InputError& error) {
        EXPECT_EQ(error.code(), ExitCode::usage);
        EXPECT_NE(std::string(error.what()).find(option), std::string::npos) << error.what();
    }
}

TEST(Options, DefaultsDependOnTheRecipe) {
    Options options;
    EXPECT_EQ(resolve_options(options, 10, false, false).alpha,
              default_alpha(CrossFieldMethod::convex));
    EXPECT_EQ(resolve_options(options, 10, false, false).metric, MetricChoice::mean);
    options.field = CrossFieldMethod::paper;
    EXPECT_EQ(resolve_options(options, 10, false, false).alpha,
              default_alpha(CrossFieldMethod::paper));
}

TEST(Options, LandmarksAskForMirroredQuads) {
    EXPECT_EQ(resolve_options({}, 10, false, true).symmetry, SymmetryMode::exact);
    EXPECT_EQ(resolve_options({}, 10, false, false).symmetry, SymmetryMode::none);
    Options options;
    options.symmetry = SymmetryMode::none;
    EXPECT_EQ(resolve_options(options, 10, false, true).symmetry, SymmetryMode::none);
}

TEST(Options, ThePaperAveragesOverOrbits) {
    EXPECT_EQ(resolve_options({}, 10, false, true).symmetrisation, Symmetrisation::term);
    Options options;
    options.field = CrossFieldMethod::paper;
    EXPECT_EQ(resolve_options(options, 10, false, true).symmetrisation, Symmetrisation::orbits);
    options.symmetrisation = Symmetrisation::term;
    expect_refused(options, "--symmetrise");
}

TEST(Options, WithoutAnimationTheRunSeesTheReferenceFrameUnlessToldOtherwise) {
    Options options;
    options.alpha = 0;
    EXPECT_TRUE(is_single_pose(resolve_options(options, 10, false, false)));
    options.metric = MetricChoice::mean;
    EXPECT_FALSE(is_single_pose(resolve_options(options, 10, false, false)));
    options.alpha = 0.1;
    options.metric = MetricChoice::reference;
    EXPECT_FALSE(is_single_pose(resolve_options(options, 10, false, false)));
}

TEST(Options, RefusesValuesOutOfRange) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double alpha : {-0.1, 1.0, nan}) {
        Options options;
        options.alpha = alpha;
        expect_refused(options, "--alpha");
    }
    for (const double length : {-1.0, nan, std::numeric_limits<double>::infinity()}) {
        Options options;
        options.edge_length = length;
        expect_refused(options, "--edge-length");
    }
    Options options;
    options.vertices = 0;
    expect_refused(options, "--vertices");
    options.edge_length = 0.1;
    EXPECT_NO_THROW(resolve_options(options, 10, false, false))
        << "--vertices has no say beside a length";
}

TEST(Options, TheReferenceIsAFrameOfTheInput) {
    Options options;
    options.reference = 9;
    EXPECT_NO_THROW(resolve_options(options, 10, false, false));
    options.reference = 10;
    expect_refused(options, "--reference");
    options.reference = Options::rest_shape;
    expect_refused(options, "--reference");
    EXPECT_NO_THROW(resolve_options(options, 10, true, false));
}

}  // namespace
}  // namespace kinequad
