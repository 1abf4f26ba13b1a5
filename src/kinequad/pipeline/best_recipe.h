#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "kinequad/pipeline/solve_quads.h"

namespace kinequad {

/// What one recipe made of a run, up to the quads before relaxation.
struct SolvedRecipe {
    Options options;
    Domain domain;
    CrossField field;
    std::optional<FieldSymmetry> field_symmetry;
    GridMap map;
    std::vector<std::string> notes;
    QuadMesh quads_on_input;
    QuadMesh quads;  ///< vertices are points of the domain's triangles
};

/// Whether a recipe comes to far fewer or more quads than were asked for.
bool misses_wanted_count(const SolvedRecipe& recipe);

/// How a recipe is followed.
struct RecipeSteps {
    /// Solves the recipe `result.options`: fills in field and map, returns the quads, in the
    /// triangles of the domain.
    std::function<QuadMesh()> solve;
    /// Relaxes what has been solved; vertices become points of the surface of the run. Called from
    /// several threads at once.
    std::function<QuadMesh(const SolvedRecipe&, const Context&)> finish;
    std::size_t together = 1;  ///< recipes that are finished at the same time
};

/// Solves the recipes of `result.options` one after the other and finishes the `steps.together`
/// most promising ones: those whose quads have the best angles over some frames of the `views`, a
/// singularity weighing as much as 0.2 % of them. Keeps in `result` the one that is best once it is
/// relaxed: fewest folded quads in the pose `reference` (n x 3) of `frames`, the surface of the
/// run, then angles and, a tenth as much, the Hausdorff distance. Where they are farther from the
/// input than usual, the next ones are finished, four at most. Recipes that miss the wanted number
/// of vertices stand behind the others, as do those whose map leaves out some of the line of
/// symmetry, and those that fail are left out, unless all do. Returns
/// the finished quads. Throws what the `steps` throw. docs/pipeline.md
QuadMesh finish_best_recipe(const FrameSource& frames, const Positions& reference,
                            const std::vector<DomainView>& views, Result& result,
                            const RecipeSteps& steps, const Context& context,
                            const StageEnd& finish_stage);

}  // namespace kinequad
