#include "kinequad/pipeline/compare_methods.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "kinequad/core/error.h"
#include "kinequad/io/memory_sequence.h"
#include "kinequad/pipeline/make_report.h"
#include "kinequad/transfer/transfer.h"
#include "stretched_torus.h"
#include "support/shapes.h"

namespace kinequad {
namespace {

TEST(ComparisonRecipes, AreTheFourOfTheComparison) {
    Options base = test::options_with(700);
    base.reference = 2;
    base.relax_rounds = 5;
    const std::vector<ComparedRecipe> recipes = comparison_recipes(base, false);
    ASSERT_EQ(recipes.size(), 4U);
    for (const ComparedRecipe& recipe : recipes) {
        EXPECT_EQ(recipe.options.vertices, 700);
        EXPECT_EQ(recipe.options.reference, 2);
        EXPECT_EQ(recipe.is_baseline, recipe.name == "animation only");
    }
    EXPECT_TRUE(is_single_pose(recipes[0].options));
    EXPECT_EQ(recipes[1].options.field, CrossFieldMethod::paper);
    EXPECT_EQ(recipes[1].options.symmetry, SymmetryMode::none);
    EXPECT_EQ(recipes[2].options.relax_rounds, 0);
    EXPECT_EQ(recipes[3].options.relax_rounds, 5);
    EXPECT_EQ(recipes[3].options.field, CrossFieldMethod::convex);
}

TEST(ComparisonRecipes, MakeThePapersFieldSymmetricWhereASymmetryIsKnown) {
    Options base = test::options_with(700);
    EXPECT_EQ(comparison_recipes(base, false)[2].options.symmetry, SymmetryMode::none);
    EXPECT_EQ(comparison_recipes(base, true)[2].options.symmetry, SymmetryMode::field);
    base.symmetry = SymmetryMode::exact;
    EXPECT_EQ(comparison_recipes(base, false)[2].options.symmetry, SymmetryMode::field);
}

TEST(CompareMethods, AForeignMeshIsMeasuredAsOurs) {
    const MemorySequence source = test::stretched_torus(3, 0.2, "some/torus.obj");
    ComparisonOptions options;
    options.recipes = {comparison_recipes(test::options_with(500), false).back()};
    const ComparisonResult ours = compare_methods(source, options, {});
    ASSERT_EQ(ours.comparison.methods.size(), 1U);
    EXPECT_EQ(ours.comparison.baseline, -1);
    EXPECT_GT(ours.comparison.methods[0].cpu_seconds, 0);
    // A torus that a plane mirrors: the error is known without landmarks.
    EXPECT_TRUE(std::isfinite(ours.comparison.methods[0].symmetry_error_degrees));

    const QuadSequence& mesh = ours.meshes[0];
    options.foreign = {{"other", mesh.faces, mesh.read_frame(0, source.read_frame(0))}};
    const ComparisonResult both = compare_methods(source, options, {});
    ASSERT_EQ(both.comparison.methods.size(), 2U);
    EXPECT_FALSE(both.options[1].has_value());
    const ComparedMethod& own = both.comparison.methods[0];
    const ComparedMethod& other = both.comparison.methods[1];
    EXPECT_EQ(other.name, "other");
    EXPECT_TRUE(std::isnan(other.cpu_seconds));
    for (std::size_t j = 0; j < 3; ++j) {
        const FrameMetrics& a = own.metrics.frames[j];
        const FrameMetrics& b = other.metrics.frames[j];
        EXPECT_NEAR(a.shape.angle_deviation_mean, b.shape.angle_deviation_mean, 1e-6);
        EXPECT_NEAR(a.distance.hausdorff_percent(), b.distance.hausdorff_percent(), 1e-6);
    }
    // A vertex on an edge may be tied to the triangle across it.
    EXPECT_NEAR(own.symmetry_error_degrees, other.symmetry_error_degrees, 0.05);
}

TEST(CompareMethods, AllHaveAsManyVerticesAsTheOneThatNeedsMost) {
    const MemorySequence source = test::stretched_torus(2, 0.2, "some/torus.obj");
    ComparisonOptions options;
    options.measure.measure_distance = false;
    options.recipes = {{"coarse", "", test::options_with(300)},
                       {"fine", "", test::options_with(600), true}};
    std::vector<std::string> warnings;
    Context context;
    context.log = [&](LogLevel level, std::string_view line) {
        if (level == LogLevel::warning) warnings.emplace_back(line);
    };
    const ComparisonResult result = compare_methods(source, options, context);
    ASSERT_EQ(result.comparison.methods.size(), 2U);
    EXPECT_EQ(result.comparison.baseline, 1);
    const double fine = static_cast<double>(result.comparison.methods[1].metrics.quads.vertices);
    EXPECT_NEAR(fine, 600, 30);
    const double coarse = static_cast<double>(result.comparison.methods[0].metrics.quads.vertices);
    EXPECT_NEAR(coarse, fine, 0.05 * fine);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_EQ(warnings[0].rfind("coarse is made again with", 0), 0U) << warnings[0];
}

TEST(CompareMethods, WarnsOfAForeignMeshInAnotherPose) {
    const MemorySequence source = test::stretched_torus(3, 0.2, "some/torus.obj");
    ComparisonOptions options;
    const TriangleMesh torus = test::torus(12, 8);
    Positions elsewhere = torus.V;
    elsewhere.col(2).array() += 1;
    options.foreign = {{"far", make_polygons(torus.F), elsewhere}};
    options.measure.measure_distance = false;
    std::string warning;
    Context context;
    context.log = [&](LogLevel level, std::string_view line) {
        if (level == LogLevel::warning) warning = line;
    };
    compare_methods(source, options, context);
    EXPECT_NE(warning.find("far"), std::string::npos) << warning;
}

TEST(CompareMethods, RefusesANameThatOccursTwice) {
    const MemorySequence source = test::stretched_torus(1, 0.2, "some/torus.obj");
    ComparisonOptions options;
    options.recipes = comparison_recipes(test::options_with(500), false);
    options.foreign = {{"paper", {}, {}}};
    EXPECT_THROW(compare_methods(source, options, {}), InputError);
}

TEST(CompareMethods, StopsWhenAsked) {
    const MemorySequence source = test::stretched_torus(2, 0.2, "some/torus.obj");
    ComparisonOptions options;
    options.recipes = comparison_recipes(test::options_with(500), false);
    const std::atomic<bool> cancel = true;
    Context context;
    context.cancel = &cancel;
    EXPECT_THROW(compare_methods(source, options, context), Cancelled);
}

TEST(MakeReport, ShowsMethodsTheirOptionsAndPictures) {
    const MemorySequence source = test::stretched_torus(3, 0.2, "some/torus.obj");
    ComparisonOptions options;
    options.recipes = comparison_recipes(test::options_with(500), false);
    options.recipes.erase(options.recipes.begin() + 1, options.recipes.begin() + 3);
    PictureOptions pictures;
    pictures.frames = {1};
    pictures.pixels = 4000;
    const ComparisonResult result = compare_methods(source, options, {});
    const Report report = make_comparison_report(result, source, pictures, {});
    EXPECT_EQ(report.title, "torus: methods compared");
    EXPECT_EQ(report.highlighted, 1);
    EXPECT_EQ(report.options.columns, (std::vector<std::string>{"single pose", "kinequad"}));
    for (const ReportTable::Row& row : report.options.rows) EXPECT_EQ(row.cells.size(), 2U);
    ASSERT_EQ(report.pictures.size(), 1U);
    EXPECT_EQ(report.pictures[0].panels.size(), 2U);
}

}  // namespace
}  // namespace kinequad
