#include "kinequad/pipeline/options.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <string>
#include <tuple>
#include <vector>

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

std::vector<Options> recipes(const Options& options, bool has_landmarks = false) {
    return list_recipes(resolve_options(options, 10, false, has_landmarks));
}

TEST(Options, DefaultsDependOnTheMethod) {
    Options options;
    for (const CrossFieldMethod method : {CrossFieldMethod::convex, CrossFieldMethod::paper}) {
        options.field = method;
        EXPECT_EQ(resolve_options(options, 10, false, false).metric,
                  method == CrossFieldMethod::paper ? MetricChoice::reference : MetricChoice::mean);
        ASSERT_EQ(recipes(options).size(), 1U);
        EXPECT_EQ(recipes(options)[0].alpha, default_alpha(method));
    }
}

TEST(Recipes, AreSeveralWhereBothSidesShareTheQuadsAndNothingIsGiven) {
    for (const SymmetryMode mode : {SymmetryMode::field, SymmetryMode::exact}) {
        Options options;
        options.symmetry = mode;
        EXPECT_GT(recipes(options).size(), 1U);
        options.alpha = 0.3;
        options.symmetrisation = Symmetrisation::term;
        const std::vector<Options> given = recipes(options);
        ASSERT_EQ(given.size(), 1U);
        EXPECT_EQ(given[0].alpha, 0.3);
        EXPECT_EQ(given[0].symmetrisation, Symmetrisation::term);
    }
    // Either way to a symmetric field is tried with the influence that was given.
    for (const SymmetryMode mode : {SymmetryMode::field, SymmetryMode::exact}) {
        Options options;
        options.symmetry = mode;
        options.alpha = 0.3;
        const std::vector<Options> both = recipes(options);
        ASSERT_EQ(both.size(), 2U);
        EXPECT_NE(both[0].symmetrisation, both[1].symmetrisation);
        EXPECT_EQ(both[1].alpha, 0.3);
    }
}

TEST(Recipes, LeaveNothingEmptyAndKeepWhatIsGiven) {
    Options options;
    options.singularity_cost = 0.3;
    options.vertices = 1234;
    for (const SymmetryMode mode : {SymmetryMode::none, SymmetryMode::field, SymmetryMode::exact}) {
        options.symmetry = mode;
        for (const Options& recipe : recipes(options)) {
            EXPECT_TRUE(recipe.alpha && recipe.symmetrisation && recipe.metric);
            EXPECT_EQ(recipe.singularity_cost, 0.3);
            EXPECT_EQ(recipe.vertices, 1234);
        }
    }
}

TEST(Recipes, NeverRepeatThemselves) {
    for (const SymmetryMode mode : {SymmetryMode::none, SymmetryMode::field, SymmetryMode::exact}) {
        for (const bool is_cost_given : {false, true}) {
            Options options;
            options.symmetry = mode;
            if (is_cost_given) options.singularity_cost = 0.3;
            std::set<std::tuple<Symmetrisation, double, double>> seen;
            for (const Options& recipe : recipes(options)) {
                EXPECT_TRUE(
                    seen.insert({*recipe.symmetrisation, *recipe.alpha, *recipe.singularity_cost})
                        .second);
            }
        }
    }
}

TEST(Options, ThePaperMakesTheFieldSymmetricByOrbits) {
    Options options;
    options.field = CrossFieldMethod::paper;
    EXPECT_EQ(resolve_options(options, 10, false, true).symmetry, SymmetryMode::field);
    EXPECT_EQ(resolve_options(options, 10, false, false).symmetry, SymmetryMode::none);
    const std::vector<Options> made = recipes(options, true);
    ASSERT_EQ(made.size(), 1U);
    EXPECT_EQ(made[0].symmetrisation, Symmetrisation::orbits);
    // What a run with mirrored quads records can be given again.
    options.symmetry = SymmetryMode::exact;
    for (const Options& recorded : recipes(options, true)) {
        EXPECT_EQ(recipes(recorded, true).size(), 1U);
    }
    options.symmetry = SymmetryMode::field;
    options.symmetrisation = Symmetrisation::term;
    expect_refused(options, "--symmetrise");
}

TEST(Options, LandmarksAskForMirroredQuads) {
    EXPECT_EQ(resolve_options({}, 10, false, true).symmetry, SymmetryMode::exact);
    EXPECT_EQ(resolve_options({}, 10, false, false).symmetry, SymmetryMode::none);
    Options options;
    options.symmetry = SymmetryMode::none;
    EXPECT_EQ(resolve_options(options, 10, false, true).symmetry, SymmetryMode::none);
}

TEST(Options, ThePaperAveragesOverOrbits) {
    Options options;
    options.field = CrossFieldMethod::paper;
    options.symmetry = SymmetryMode::field;
    ASSERT_EQ(recipes(options).size(), 1U);
    EXPECT_EQ(recipes(options)[0].symmetrisation, Symmetrisation::orbits);
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
