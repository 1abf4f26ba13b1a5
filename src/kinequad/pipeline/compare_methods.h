#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinequad/core/context.h"
#include "kinequad/io/frame_source.h"
#include "kinequad/io/landmarks.h"
#include "kinequad/measure/comparison.h"
#include "kinequad/pipeline/options.h"
#include "kinequad/pipeline/stage_clock.h"

namespace kinequad {

/// A way to make quads that takes part in a comparison.
struct ComparedRecipe {
    std::string name;         ///< short and unique
    std::string description;  ///< one sentence
    Options options;
    bool is_baseline = false;  ///< the one that the others are counted against
};

/// The four recipes that the paper's section 4 asks to be compared: a single pose, the animation
/// without symmetry (the paper's baseline), the paper's method to the letter, and the defaults of
/// Kinequad. `base` says how many vertices, in which reference frame, and what else the defaults
/// are.
std::vector<ComparedRecipe> comparison_recipes(const Options& base, bool has_landmarks);

/// A mesh of another program in the pose of the reference frame.
struct ForeignMesh {
    std::string name;
    Polygons faces;
    Positions X;  ///< v x 3
};

/// What is compared, and how it is measured.
struct ComparisonOptions {
    std::vector<ComparedRecipe> recipes;
    std::vector<ForeignMesh> foreign;
    std::optional<Landmarks> landmarks;
    int reference = 0;  ///< frame in which foreign meshes are, or `Options::rest_shape`
    MeasureOptions measure;
};

/// A comparison and what else is known of each of its methods, in the same order.
struct ComparisonResult {
    Comparison comparison;
    std::vector<QuadSequence> meshes;
    std::vector<std::vector<StageTime>> times;    ///< empty for a foreign mesh
    std::vector<std::optional<Options>> options;  ///< with empty fields filled in
};

/// Makes quads by every recipe, carries foreign meshes through the frames from the reference, and
/// measures all of them together. Where one recipe needs more vertices than were wanted, as for
/// want of room for its singularities, the others are made again with as many, within 5 %. The
/// symmetry error is measured with the map from the landmarks, or of a pose that a plane mirrors;
/// without either it stays unknown. A recipe that finds no valid mesh is left out with a warning;
/// where none does, its error is thrown. Throws as `quadrangulate` and `measure_sequences`, and
/// `InputError` (usage) where a name occurs twice. docs/report.md
ComparisonResult compare_methods(const FrameSource& source, const ComparisonOptions& options,
                                 const Context& context);

}  // namespace kinequad
