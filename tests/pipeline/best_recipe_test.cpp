#include "kinequad/pipeline/best_recipe.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kinequad/core/error.h"
#include "kinequad/io/memory_sequence.h"
#include "kinequad/measure/quad_shape.h"
#include "kinequad/mesh/closest_points.h"
#include "kinequad/pipeline/result.h"
#include "kinequad/transfer/transfer.h"
#include "support/shapes.h"

namespace kinequad {
namespace {

/// Recipes over a unit square; `solve` makes one quad of it, slanted by as much as is asked for.
class BestRecipe : public testing::Test {
protected:
    BestRecipe()
        : mesh_(test::square(4)),
          source_(mesh_.F, {mesh_.V}),
          views_{{source_, mesh_.V,
                  metric_of(build_topology(mesh_.F, static_cast<int>(mesh_.V.rows())), mesh_.V)}} {
        Options options;
        options.symmetry = SymmetryMode::exact;
        options_ = resolve_options(options, 1, false, true);
        recipes_ = list_recipes(options_);
    }

    /// The quad with these corners.
    QuadMesh one_quad(const std::array<std::array<double, 2>, 4>& corners) const {
        QuadMesh quads;
        quads.Q.resize(1, 4);
        quads.Q << 0, 1, 2, 3;
        for (const auto& [x, y] : corners) {
            quads.vertex.push_back(ClosestPoints(mesh_.V, mesh_.F).find(Vector3(x, y, 0)).point);
        }
        return quads;
    }

    /// A quad of the square whose upper corners are moved to the right by `slant`.
    QuadMesh slanted(double slant) const {
        return one_quad({{{0.1, 0.1}, {0.5, 0.1}, {0.5 + slant, 0.5}, {0.1 + slant, 0.5}}});
    }

    /// A quad that is folded, of better angles than one that is slanted by 0.45.
    QuadMesh folded() const {
        return one_quad({{{0.1, 0.1}, {0.5, 0.1}, {0.28, 0.28}, {0.1, 0.5}}});
    }

    /// What a recipe is to come to.
    struct Outcome {
        double slant = 0;
        int singular = 0;
        double quads = 1000;
        int lost_line_edges = 0;
        bool fails = false;
        double relaxed_slant = 0;
        bool covers_when_relaxed = false;
        bool folds_when_relaxed = false;
        bool fails_when_relaxed = false;
    };

    std::size_t number_of(const Options& recipe) const {
        std::size_t i = 0;
        while (recipes_[i].alpha != recipe.alpha ||
               recipes_[i].symmetrisation != recipe.symmetrisation)
            ++i;
        return i;
    }

    QuadMesh choose(const std::vector<Outcome>& outcomes, int threads = 1) {
        stages_.clear();
        relaxed_ = std::vector<char>(recipes_.size(), 0);
        log_.clear();
        warnings_.clear();
        result_.options = options_;
        result_.edge_length = 0.4;
        const auto solve = [&] {
            const std::size_t i = number_of(result_.options);
            const Outcome& outcome = outcomes[i];
            if (outcome.fails) throw GridMapError("recipe " + std::to_string(i));
            result_.field.index = Eigen::VectorXi::Zero(100);
            result_.field.index.head(outcome.singular).setOnes();
            result_.map.wanted_quads = 1000;
            result_.map.quads = outcome.quads;
            result_.map.lost_line_edges = outcome.lost_line_edges;
            return slanted(outcome.slant);
        };
        const auto finish = [&](const SolvedRecipe& solved, const Context& context) {
            const std::size_t i = number_of(solved.options);
            context.write_log(LogLevel::info, "relaxes " + std::to_string(i));
            context.write_log(LogLevel::warning, "relaxed " + std::to_string(i));
            relaxed_[i] = 1;
            if (outcomes[i].fails_when_relaxed) {
                throw VerificationError("relaxed " + std::to_string(i));
            }
            if (outcomes[i].covers_when_relaxed)
                return one_quad({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}});
            return outcomes[i].folds_when_relaxed ? folded() : slanted(outcomes[i].relaxed_slant);
        };
        Context context;
        context.threads = threads;
        context.log = [&](LogLevel level, std::string_view line) {
            (level == LogLevel::warning ? warnings_ : log_).emplace_back(line);
        };
        return finish_best_recipe(source_, mesh_.V, views_, result_, {solve, finish, 2}, context,
                                  [&](const char* stage) { stages_.emplace_back(stage); });
    }

    bool is_kept(std::size_t recipe) const { return number_of(result_.options) == recipe; }

    TriangleMesh mesh_;
    MemorySequence source_;
    std::vector<DomainView> views_;
    Options options_;
    Result result_;
    std::vector<Options> recipes_;
    std::vector<std::string> stages_;
    std::vector<char> relaxed_;
    std::vector<std::string> log_;
    std::vector<std::string> warnings_;
};

TEST_F(BestRecipe, IsTheOneWithTheBestAngles) {
    std::vector<Outcome> outcomes(recipes_.size(), Outcome{.slant = 0.2});
    outcomes[1].slant = 0.1;
    const QuadMesh quads = choose(outcomes);
    EXPECT_TRUE(is_kept(1));
    EXPECT_EQ(quads.vertex, slanted(0).vertex);
    // Whoever watches is shown its stages again.
    EXPECT_EQ(stages_, (std::vector<std::string>{"relaxation", "field", "map", "extraction"}));
    outcomes.back().slant = 0.05;
    choose(outcomes);
    EXPECT_TRUE(stages_.empty());
}

TEST_F(BestRecipe, TakesFewerSingularitiesBeforeAnglesAboutAsGood) {
    std::vector<Outcome> outcomes(recipes_.size(), Outcome{.slant = 0.3});
    outcomes[0] = {.slant = 0.1, .singular = 60};
    outcomes[1] = {.slant = 0.105, .singular = 10};
    choose(outcomes);
    EXPECT_TRUE(is_kept(1));
    EXPECT_EQ((result_.field.index.array() != 0).count(), 10);
}

TEST_F(BestRecipe, KeepsToTheWantedNumber) {
    std::vector<Outcome> outcomes(recipes_.size(), Outcome{.slant = 0.01, .quads = 1100});
    outcomes[1] = {.slant = 0.2};
    choose(outcomes);
    EXPECT_TRUE(is_kept(1));
}

TEST_F(BestRecipe, KeepsTheLineOfSymmetryIfItCan) {
    std::vector<Outcome> outcomes(recipes_.size(), Outcome{.slant = 0.1, .lost_line_edges = 3});
    outcomes[2] = {.slant = 0.2};
    choose(outcomes);
    EXPECT_TRUE(is_kept(2));
    EXPECT_EQ(std::count(relaxed_.begin(), relaxed_.end(), 1), 1);
    EXPECT_EQ(warnings_, (std::vector<std::string>{"relaxed 2"}));
    outcomes[2] = {.slant = 0.01, .quads = 1100};
    choose(outcomes);
    EXPECT_FALSE(is_kept(2));
    ASSERT_EQ(warnings_.size(), 2U);
    EXPECT_NE(warnings_[1].find("line of symmetry along 3 of its edges"), std::string::npos);
}

TEST_F(BestRecipe, IsTheOneThatIsBestOnceItIsRelaxed) {
    std::vector<Outcome> outcomes(recipes_.size(), Outcome{.slant = 0.3});
    outcomes[0] = {.slant = 0.1, .relaxed_slant = 0.08};
    outcomes[2] = {.slant = 0.102, .relaxed_slant = 0.05};
    const QuadMesh quads = choose(outcomes);
    EXPECT_TRUE(is_kept(2));
    EXPECT_EQ(quads.vertex, slanted(0.05).vertex);
    EXPECT_EQ(warnings_, (std::vector<std::string>{"relaxed 2"}));
    // Those far behind are not relaxed.
    EXPECT_EQ(relaxed_, (std::vector<char>{1, 0, 1, 0, 0}));

    const std::vector<std::string> lines = log_;
    EXPECT_EQ(choose(outcomes, 2).vertex, quads.vertex);
    EXPECT_EQ(log_, lines);
}

TEST_F(BestRecipe, IsLookedForAmongMoreWhereQuadsAreFarFromTheInput) {
    std::vector<Outcome> outcomes = {{.slant = 0.1, .relaxed_slant = 0.1},
                                     {.slant = 0.101, .relaxed_slant = 0.1},
                                     {.slant = 0.102, .covers_when_relaxed = true},
                                     {.slant = 0.3},
                                     {.slant = 0.3}};
    choose(outcomes);
    EXPECT_TRUE(is_kept(2));
    EXPECT_EQ(relaxed_, (std::vector<char>{1, 1, 1, 0, 0}));
    outcomes[1].covers_when_relaxed = true;
    choose(outcomes);
    EXPECT_TRUE(is_kept(1));
    EXPECT_EQ(relaxed_, (std::vector<char>{1, 1, 0, 0, 0}));
}

TEST_F(BestRecipe, HasNoFoldedQuadsWhereAnotherHasNone) {
    std::vector<Outcome> outcomes(recipes_.size(), Outcome{.slant = 0.3});
    outcomes[0] = {.slant = 0.1, .folds_when_relaxed = true};
    outcomes[1] = {.slant = 0.102, .relaxed_slant = 0.45};
    choose(outcomes);
    EXPECT_TRUE(is_kept(1));
    EXPECT_LT(
        measure_shape(quad_positions(folded(), mesh_.V, mesh_.F), folded().Q).angle_deviation_mean,
        measure_shape(quad_positions(slanted(0.45), mesh_.V, mesh_.F), folded().Q)
            .angle_deviation_mean);
}

TEST_F(BestRecipe, IsFoundAmongThoseThatDoNotFailWhenRelaxed) {
    std::vector<Outcome> outcomes(recipes_.size(), Outcome{.slant = 0.3});
    outcomes[0] = {.slant = 0.1, .fails_when_relaxed = true};
    outcomes[3] = {.slant = 0.102, .relaxed_slant = 0.1};
    choose(outcomes);
    EXPECT_TRUE(is_kept(3));
    EXPECT_EQ(std::count_if(log_.begin(), log_.end(),
                            [](const std::string& line) {
                                return line.starts_with("recipe: not relaxed") &&
                                       line.ends_with("relaxed 0");
                            }),
              1);
    outcomes[3].fails_when_relaxed = true;
    try {
        choose(outcomes);
        ADD_FAILURE() << "both failed";
    } catch (const VerificationError& error) {
        EXPECT_STREQ(error.what(), "relaxed 0");
    }
}

TEST_F(BestRecipe, IsFoundAmongThoseThatDoNotFail) {
    std::vector<Outcome> outcomes(recipes_.size(), Outcome{.fails = true});
    EXPECT_THROW(choose(outcomes), GridMapError);
    outcomes[1].fails = false;
    choose(outcomes);
    EXPECT_TRUE(is_kept(1));
}

}  // namespace
}  // namespace kinequad
