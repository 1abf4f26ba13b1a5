#include "kinequad/pipeline/best_recipe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <exception>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "kinequad/core/error.h"
#include "kinequad/core/parallel.h"
#include "kinequad/measure/measure_sequence.h"
#include "kinequad/measure/quad_shape.h"
#include "kinequad/transfer/transfer.h"

namespace kinequad {
namespace {

/// Mean over some frames of the views, evenly chosen, of what corners of `quads` differ from right
/// angles by, in degrees.
double mean_angle_deviation(const QuadMesh& quads, const std::vector<DomainView>& views) {
    constexpr int most_frames = 12;
    double sum = 0;
    int frames = 0;
    for (const DomainView& view : views) {
        for (const int frame : evenly_chosen_frames(view.frames.frame_count(), most_frames)) {
            const Positions input = view.frames.read_frame(frame);
            const Positions X = quad_positions(quads, input, view.frames.triangles());
            sum += measure_shape(X, quads.Q).angle_deviation_mean;
            ++frames;
        }
    }
    return sum / frames;
}

/// A recipe, and how good it is before relaxation.
struct Candidate {
    SolvedRecipe recipe;
    bool is_off_count = false;
    bool has_lost_lines = false;  ///< of symmetry
    double angle = 0;             ///< mean deviation, in degrees
    std::ptrdiff_t singular = 0;

    double cost() const {
        constexpr double share_of_singularity = 0.002;
        return angle * (1 + share_of_singularity * static_cast<double>(singular));
    }
    bool operator<(const Candidate& other) const {
        return std::tuple(is_off_count, has_lost_lines, cost()) <
               std::tuple(other.is_off_count, other.has_lost_lines, other.cost());
    }
};

/// Takes what the last recipe made out of `result`.
Candidate take_candidate(Result& result, QuadMesh quads, const std::vector<DomainView>& views) {
    Candidate candidate;
    candidate.recipe = {result.options,          std::move(result.domain), std::move(result.field),
                        result.field_symmetry,   std::move(result.map),    std::move(result.notes),
                        std::move(result.quads), std::move(quads)};
    const SolvedRecipe& recipe = candidate.recipe;
    candidate.is_off_count = misses_wanted_count(recipe);
    candidate.has_lost_lines = recipe.map.lost_line_edges > 0;
    candidate.angle = mean_angle_deviation(recipe.quads, views);
    candidate.singular = (recipe.field.index.array() != 0).count();
    if (recipe.domain.is_half()) candidate.singular *= 2;
    return candidate;
}

/// Puts it back.
void put_recipe(SolvedRecipe recipe, Result& result) {
    result.options = recipe.options;
    result.domain = std::move(recipe.domain);
    result.field = std::move(recipe.field);
    result.field_symmetry = recipe.field_symmetry;
    result.map = std::move(recipe.map);
    result.notes = std::move(recipe.notes);
    result.quads = std::move(recipe.quads_on_input);
}

std::string name_of(const Options& recipe) {
    return fmt::format(
        "alpha {}, singularities at {}{}", *recipe.alpha, *recipe.singularity_cost,
        recipe.symmetrisation == Symmetrisation::orbits ? " and orbits averaged" : "");
}

/// Why a recipe failed with `failure`, where another may take its place; throws it where none may.
std::string reason_of(const std::exception_ptr& failure) {
    try {
        std::rethrow_exception(failure);
    } catch (const Error& error) {
        if (!may_be_overcome(error)) throw;
        return error.what();
    }
}

/// Leaves the most promising of `candidates` alone, the best first: those that may still turn out
/// best once they are relaxed.
void keep_promising(std::vector<Candidate>& candidates) {
    constexpr std::ptrdiff_t most_kept = 4;
    constexpr double most_behind = 0.08;
    std::stable_sort(candidates.begin(), candidates.end());
    const Candidate& best = candidates.front();
    const auto end = std::find_if(candidates.begin(), candidates.end(), [&](const Candidate& c) {
        return c.is_off_count != best.is_off_count || c.has_lost_lines != best.has_lost_lines ||
               c.cost() > (1 + most_behind) * best.cost();
    });
    candidates.erase(candidates.begin() + std::min(end - candidates.begin(), most_kept),
                     candidates.end());
}

/// The most promising of `recipes`, solved one after the other, the best first. Those that fail are
/// left out, unless all do.
std::vector<Candidate> solve_recipes(const std::vector<Options>& recipes,
                                     const std::vector<DomainView>& views, Result& result,
                                     const std::function<QuadMesh()>& solve,
                                     const Context& context) {
    const Domain domain = result.domain;
    std::vector<Candidate> candidates;
    std::exception_ptr failure;
    for (const Options& recipe : recipes) {
        result.options = recipe;
        result.domain = domain;
        result.notes.clear();
        try {
            candidates.push_back(take_candidate(result, solve(), views));
            context.write_log(
                LogLevel::info,
                fmt::format(
                    "recipe: {} singularities and angles {:.2f} degrees off before relaxation{}, "
                    "with {}",
                    candidates.back().singular, candidates.back().angle,
                    candidates.back().has_lost_lines ? ", parts of the line of symmetry lost" : "",
                    name_of(recipe)));
            keep_promising(candidates);
        } catch (const Error& error) {
            if (!may_be_overcome(error)) throw;
            failure = std::current_exception();
            context.write_log(LogLevel::info, fmt::format("recipe: none with {}: {}",
                                                          name_of(recipe), error.what()));
        }
    }
    if (candidates.empty()) std::rethrow_exception(failure);
    return candidates;
}

/// Relaxed quads of a recipe, or why there are none.
struct Finished {
    QuadMesh quads;
    std::exception_ptr failure;
    std::vector<std::pair<LogLevel, std::string>> lines;  ///< without the warnings
    std::vector<std::string> warnings;
};

/// Finishes `candidates` at the same time. Log lines are kept back until all are done, warnings
/// for whoever takes the quads; progress is that of the first.
std::vector<Finished> finish_together(std::span<const Candidate> candidates,
                                      const RecipeSteps& steps, const Context& context) {
    std::vector<Finished> finished(candidates.size());
    parallel_for(candidates.size(), 1, context, [&](std::size_t i, std::size_t) {
        Context own = context;
        if (i > 0) own.progress = nullptr;
        own.log = [&made = finished[i]](LogLevel level, std::string_view line) {
            if (level == LogLevel::warning) made.warnings.emplace_back(line);
            if (level != LogLevel::warning) made.lines.emplace_back(level, line);
        };
        try {
            finished[i].quads = steps.finish(candidates[i].recipe, own);
        } catch (...) {
            finished[i].failure = std::current_exception();
        }
    });
    for (const Finished& made : finished) {
        for (const auto& [level, line] : made.lines) context.write_log(level, line);
    }
    return finished;
}

/// How good relaxed quads are; less is better.
struct Grade {
    int folded = 0;       ///< quads folded in the reference
    double cost = 0;      ///< by angles and distance from the input
    double distance = 0;  ///< from the input, mean over the frames, in edge lengths

    bool operator<(const Grade& other) const {
        return std::tuple(folded, cost) < std::tuple(other.folded, other.cost);
    }
};

/// Grades `quads`, of edges as long as `edge_length`, in the pose `reference` (n x 3) and some of
/// `frames`, evenly chosen.
Grade grade_of(const QuadMesh& quads, const FrameSource& frames, const Positions& reference,
               double edge_length, const std::string& name, const Context& context) {
    constexpr int most_frames = 24;
    constexpr double weight_of_distance = 0.1;
    constexpr double least_distance = 0.05;  // closer ones are all alike
    MeasureOptions options;
    options.frame_step = (frames.frame_count() + most_frames - 1) / most_frames;
    Context quiet = context;
    quiet.progress = nullptr;
    const std::vector<FrameMetrics> measured =
        measure_sequence(frames, follow_surface(quads, frames.triangles()), {}, options, quiet)
            .frames;
    const double edge_percent = 100 * edge_length / bounding_box_diagonal(reference);
    const double share = 1 / static_cast<double>(measured.size());
    double angle = 0;
    double distance = 0;
    for (const FrameMetrics& frame : measured) {
        angle += share * frame.shape.angle_deviation_mean;
        distance += share * frame.distance.hausdorff_percent();
    }
    Grade grade;
    grade.distance = distance / edge_percent;
    grade.folded =
        measure_shape(quad_positions(quads, reference, frames.triangles()), quads.Q).folded_quads;
    grade.cost = angle * std::pow(std::max(grade.distance, least_distance), weight_of_distance);
    context.write_log(LogLevel::info,
                      fmt::format("recipe: angles {:.2f} degrees off, {:.3f} % away and {} folded "
                                  "after relaxation, with {}",
                                  angle, distance, grade.folded, name));
    return grade;
}

}  // namespace

bool misses_wanted_count(const SolvedRecipe& recipe) {
    constexpr double allowed = 0.05;
    return !recipe.notes.empty() ||
           std::abs(recipe.map.quads / recipe.map.wanted_quads - 1) > allowed;
}

QuadMesh finish_best_recipe(const FrameSource& frames, const Positions& reference,
                            const std::vector<DomainView>& views, Result& result,
                            const RecipeSteps& steps, const Context& context,
                            const StageEnd& finish_stage) {
    // Quads come as close as this, in edge lengths, unless something is in the way; where they do
    // not, the next recipes are worth their time.
    constexpr double usual_distance = 0.65;
    const std::vector<Options> recipes = list_recipes(result.options);
    std::vector<Candidate> candidates = solve_recipes(recipes, views, result, steps.solve, context);
    // Without relaxation all is known already.
    if (result.options.relax_rounds == 0)
        candidates.erase(candidates.begin() + 1, candidates.end());
    std::optional<std::size_t> best;
    Grade least;
    Finished kept;
    std::exception_ptr failure;
    const auto is_close = [&] { return best && least.distance <= usual_distance; };
    for (std::size_t i = 0; i < candidates.size() && !is_close();) {
        const std::size_t count = std::min(steps.together, candidates.size() - i);
        for (Finished& made :
             finish_together(std::span(candidates).subspan(i, count), steps, context)) {
            const std::size_t candidate = i++;
            const std::string name = name_of(candidates[candidate].recipe.options);
            if (made.failure) {
                context.write_log(LogLevel::info, fmt::format("recipe: not relaxed with {}: {}",
                                                              name, reason_of(made.failure)));
                if (!failure) failure = made.failure;
                continue;
            }
            const Grade grade =
                candidates.size() == 1
                    ? Grade()
                    : grade_of(made.quads, frames, reference, result.edge_length, name, context);
            if (best && !(grade < least)) continue;
            best = candidate;
            least = grade;
            kept = std::move(made);
        }
    }
    if (!best) std::rethrow_exception(failure);
    for (const std::string& line : kept.warnings) context.write_log(LogLevel::warning, line);
    put_recipe(std::move(candidates[*best].recipe), result);
    if (result.map.lost_line_edges > 0) {
        context.write_log(
            LogLevel::warning,
            fmt::format("gridmap: no chain of quad edges follows the line of symmetry along {} of "
                        "its edges, where no map has it; --verbose says why",
                        result.map.lost_line_edges));
    }
    const Options& last = recipes.back();
    const bool is_last = result.options.alpha == last.alpha &&
                         result.options.symmetrisation == last.symmetrisation &&
                         result.options.singularity_cost == last.singularity_cost;
    if (!is_last) {
        // Whoever watches the stages sees those that count last. The time since is relaxation's.
        for (const char* stage : {"relaxation", "field", "map", "extraction"}) finish_stage(stage);
    }
    return std::move(kept.quads);
}

}  // namespace kinequad
