#pragma once

#include <functional>
#include <vector>

#include "kinequad/pipeline/solve_quads.h"

namespace kinequad {

/// Solves the recipes of `result.options` one after the other, each with `solve`, which fills in
/// field and map and returns the quads, in the triangles of the `views`; keeps in `result` the one
/// whose quads come out with the best angles over some frames, a singularity weighing as much as
/// 0.2 % of them. Those that miss the wanted number of vertices stand behind the others, and those
/// that fail are left out, unless all do. Throws what
/// `solve` throws. docs/pipeline.md
QuadMesh solve_best_recipe(const std::vector<DomainView>& views, Result& result,
                           const std::function<QuadMesh()>& solve, const Context& context,
                           const StageEnd& finish_stage);

}  // namespace kinequad
