#include "kinequad/pipeline/best_recipe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <exception>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "kinequad/core/error.h"
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

/// What one recipe made of a `Result`, and how good it is.
struct Attempt {
    Options options;
    Domain domain;
    CrossField field;
    std::optional<FieldSymmetry> field_symmetry;
    GridMap map;
    std::vector<std::string> notes;
    QuadMesh quads_on_input;
    QuadMesh quads;  ///< on the domain
    bool is_off_count = false;
    double angle = 0;  ///< mean deviation, in degrees
    std::ptrdiff_t singular = 0;

    bool operator<(const Attempt& other) const {
        return std::tuple(is_off_count, cost()) < std::tuple(other.is_off_count, other.cost());
    }

private:
    double cost() const {
        constexpr double share_of_singularity = 0.002;
        return angle * (1 + share_of_singularity * static_cast<double>(singular));
    }
};

/// Takes what the last recipe made out of `result`.
Attempt take_attempt(Result& result, QuadMesh quads, const std::vector<DomainView>& views) {
    constexpr double allowed = 0.05;
    Attempt attempt{result.options,          std::move(result.domain), std::move(result.field),
                    result.field_symmetry,   std::move(result.map),    std::move(result.notes),
                    std::move(result.quads), std::move(quads)};
    attempt.is_off_count = !attempt.notes.empty() ||
                           std::abs(attempt.map.quads / attempt.map.wanted_quads - 1) > allowed;
    attempt.angle = mean_angle_deviation(attempt.quads, views);
    attempt.singular = (attempt.field.index.array() != 0).count();
    if (attempt.domain.is_half()) attempt.singular *= 2;
    return attempt;
}

/// Puts it back; returns its quads.
QuadMesh put_attempt(Attempt attempt, Result& result) {
    result.options = attempt.options;
    result.domain = std::move(attempt.domain);
    result.field = std::move(attempt.field);
    result.field_symmetry = attempt.field_symmetry;
    result.map = std::move(attempt.map);
    result.notes = std::move(attempt.notes);
    result.quads = std::move(attempt.quads_on_input);
    return std::move(attempt.quads);
}

}  // namespace

QuadMesh solve_best_recipe(const std::vector<DomainView>& views, Result& result,
                           const std::function<QuadMesh()>& solve, const Context& context,
                           const StageEnd& finish_stage) {
    const std::vector<Options> recipes = list_recipes(result.options);
    if (recipes.size() == 1) {
        result.options = recipes.front();
        return solve();
    }
    const Domain domain = result.domain;
    std::optional<Attempt> best;
    bool is_best_last = false;
    std::exception_ptr failure;
    for (const Options& recipe : recipes) {
        result.options = recipe;
        result.domain = domain;
        result.notes.clear();
        is_best_last = false;
        const std::string name = fmt::format(
            "alpha {}{}", *recipe.alpha,
            recipe.symmetrisation == Symmetrisation::orbits ? " and orbits averaged" : "");
        try {
            Attempt attempt = take_attempt(result, solve(), views);
            context.write_log(LogLevel::info,
                              fmt::format("recipe: {} singularities and angles {:.2f} degrees off "
                                          "before relaxation, with {}",
                                          attempt.singular, attempt.angle, name));
            is_best_last = !best || attempt < *best;
            if (is_best_last) best = std::move(attempt);
        } catch (const Error& error) {
            if (!may_be_overcome(error)) throw;
            failure = std::current_exception();
            context.write_log(LogLevel::info,
                              fmt::format("recipe: none with {}: {}", name, error.what()));
        }
    }
    if (!best) std::rethrow_exception(failure);
    QuadMesh quads = put_attempt(*std::move(best), result);
    if (!is_best_last) {
        // Whoever watches the stages sees those that count last.
        for (const char* stage : {"field", "map", "extraction"}) finish_stage(stage);
    }
    return quads;
}

}  // namespace kinequad
