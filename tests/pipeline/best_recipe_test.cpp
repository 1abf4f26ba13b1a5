#include "kinequad/pipeline/best_recipe.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "kinequad/core/error.h"
#include "kinequad/io/memory_sequence.h"
#include "kinequad/mesh/closest_points.h"
#include "kinequad/pipeline/result.h"
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

    /// A quad of the square whose upper corners are moved to the right by `slant`.
    QuadMesh slanted(double slant) const {
        QuadMesh quads;
        quads.Q.resize(1, 4);
        quads.Q << 0, 1, 2, 3;
        for (const auto& [x, y] : std::vector<std::pair<double, double>>{
                 {0.1, 0.1}, {0.5, 0.1}, {0.5 + slant, 0.5}, {0.1 + slant, 0.5}}) {
            quads.vertex.push_back(ClosestPoints(mesh_.V, mesh_.F).find(Vector3(x, y, 0)).point);
        }
        return quads;
    }

    /// What a recipe is to come to.
    struct Outcome {
        double slant = 0;
        int singular = 0;
        double quads = 1000;
        bool fails = false;
    };

    QuadMesh choose(const std::vector<Outcome>& outcomes) {
        stages_.clear();
        result_.options = options_;
        const auto solve = [&] {
            std::size_t i = 0;
            while (recipes_[i].alpha != result_.options.alpha ||
                   recipes_[i].symmetrisation != result_.options.symmetrisation)
                ++i;
            const Outcome& outcome = outcomes[i];
            if (outcome.fails) throw GridMapError("recipe " + std::to_string(i));
            result_.field.index = Eigen::VectorXi::Zero(100);
            result_.field.index.head(outcome.singular).setOnes();
            result_.map.wanted_quads = 1000;
            result_.map.quads = outcome.quads;
            return slanted(outcome.slant);
        };
        return solve_best_recipe(views_, result_, solve, {},
                                 [&](const char* stage) { stages_.emplace_back(stage); });
    }

    TriangleMesh mesh_;
    MemorySequence source_;
    std::vector<DomainView> views_;
    Options options_;
    Result result_;
    std::vector<Options> recipes_;
    std::vector<std::string> stages_;
};

TEST_F(BestRecipe, IsTheOneWithTheBestAngles) {
    std::vector<Outcome> outcomes(recipes_.size(), Outcome{.slant = 0.2});
    outcomes[1].slant = 0.1;
    const QuadMesh quads = choose(outcomes);
    EXPECT_EQ(result_.options.alpha, recipes_[1].alpha);
    EXPECT_EQ(quads.vertex, slanted(0.1).vertex);
    // Whoever watches is shown its stages again.
    EXPECT_EQ(stages_, (std::vector<std::string>{"field", "map", "extraction"}));
    outcomes.back().slant = 0.05;
    choose(outcomes);
    EXPECT_TRUE(stages_.empty());
}

TEST_F(BestRecipe, TakesFewerSingularitiesBeforeAnglesAboutAsGood) {
    std::vector<Outcome> outcomes(recipes_.size(), Outcome{.slant = 0.3});
    outcomes[0] = {.slant = 0.1, .singular = 60};
    outcomes[1] = {.slant = 0.105, .singular = 10};
    choose(outcomes);
    EXPECT_EQ(result_.options.alpha, recipes_[1].alpha);
    EXPECT_EQ((result_.field.index.array() != 0).count(), 10);
}

TEST_F(BestRecipe, KeepsToTheWantedNumber) {
    std::vector<Outcome> outcomes(recipes_.size(), Outcome{.slant = 0.01, .quads = 1100});
    outcomes[1] = {.slant = 0.2};
    choose(outcomes);
    EXPECT_EQ(result_.options.alpha, recipes_[1].alpha);
}

TEST_F(BestRecipe, IsFoundAmongThoseThatDoNotFail) {
    std::vector<Outcome> outcomes(recipes_.size(), Outcome{.fails = true});
    EXPECT_THROW(choose(outcomes), GridMapError);
    outcomes[1].fails = false;
    choose(outcomes);
    EXPECT_EQ(result_.options.alpha, recipes_[1].alpha);
}

}  // namespace
}  // namespace kinequad
