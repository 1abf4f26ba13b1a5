#include "kinequad/pipeline/compare_methods.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "kinequad/core/error.h"
#include "kinequad/measure/symmetry_error.h"
#include "kinequad/pipeline/find_symmetry.h"
#include "kinequad/pipeline/quadrangulate.h"
#include "kinequad/pipeline/solve_quads.h"
#include "kinequad/transfer/bind_to_surface.h"
#include "kinequad/transfer/transfer.h"

namespace kinequad {
namespace {

void require_unique_names(const ComparisonOptions& options) {
    std::vector<std::string> names;
    for (const ComparedRecipe& recipe : options.recipes) names.push_back(recipe.name);
    for (const ForeignMesh& mesh : options.foreign) names.push_back(mesh.name);
    std::sort(names.begin(), names.end());
    const auto twice = std::adjacent_find(names.begin(), names.end());
    if (twice == names.end()) return;
    throw InputError(InputFault::usage,
                     fmt::format("two meshes are called '{}'; give one another name", *twice));
}

/// `context` with `name` in front of every stage that it reports.
Context named_context(const Context& context, const std::string& name) {
    Context named = context;
    if (context.progress) {
        named.progress = [&context, name](std::string_view stage, double fraction) {
            context.progress(fmt::format("{}: {}", name, stage), fraction);
        };
    }
    return named;
}

/// The symmetry map that all meshes are measured with; empty where there is none.
std::optional<SymmetryMap> find_measuring_map(const FrameSource& source,
                                              const IntrinsicMetric& metric,
                                              const std::optional<Landmarks>& landmarks,
                                              const Positions& reference, const Context& context) {
    if (landmarks) {
        // The methods have said what there is to say of the landmarks.
        Context silent = context;
        silent.log = nullptr;
        return find_symmetry(source, metric, landmarks, reference, silent).map;
    }
    try {
        return find_symmetry(source, metric, landmarks, reference, context).map;
    } catch (const InputError& error) {
        context.write_log(LogLevel::info, fmt::format("no symmetry error: {}", error.what()));
    } catch (const VerificationError& error) {
        context.write_log(LogLevel::info, fmt::format("no symmetry error: {}", error.what()));
    }
    return std::nullopt;
}

/// What takes part in a comparison, and how it was made.
struct Contestant {
    ComparedMethod method;
    QuadSequence mesh;
    std::vector<StageTime> times;
    std::optional<Options> options;
    int vertices = 0;
};

/// Makes the methods one by one, at one number of vertices, then measures all of them.
class MethodComparer {
public:
    MethodComparer(const FrameSource& source, const ComparisonOptions& options,
                   const Context& context)
        : source_(source),
          options_(options),
          context_(context),
          reference_(options.reference == Options::rest_shape
                         ? source.read_rest_shape()
                         : source.read_frame(options.reference)) {}

    ComparisonResult run() {
        for (const ComparedRecipe& recipe : options_.recipes) {
            made_.push_back(make(recipe, recipe.options));
        }
        const auto is_made = [](const auto& contestant) { return contestant.has_value(); };
        if (failure_ && std::none_of(made_.begin(), made_.end(), is_made)) {
            std::rethrow_exception(failure_);
        }
        even_out_counts();
        for (std::size_t i = 0; i < made_.size(); ++i) {
            if (!made_[i]) continue;
            if (options_.recipes[i].is_baseline) {
                result_.comparison.baseline = static_cast<int>(result_.meshes.size());
            }
            add(*std::move(made_[i]));
        }
        for (const ForeignMesh& mesh : options_.foreign) carry(mesh);
        measure();
        return std::move(result_);
    }

private:
    /// Empty where there is no valid mesh.
    std::optional<Contestant> make(const ComparedRecipe& recipe, const Options& options) {
        try {
            const Context context = named_context(context_, recipe.name);
            Result made = quadrangulate(source_, options_.landmarks, options, context);
            double seconds = 0;
            for (const StageTime& time : made.times) seconds += time.cpu_seconds;
            return Contestant{
                {recipe.name, recipe.description, {}, ComparedMethod::unknown, seconds},
                follow_surface(made.quads, source_.triangles()),
                std::move(made.times),
                made.options,
                static_cast<int>(made.quads.vertex.size())};
        } catch (const GridMapError& error) {
            warn_of_failure(recipe, options, error.what());
        } catch (const VerificationError& error) {
            warn_of_failure(recipe, options, error.what());
        }
        return std::nullopt;
    }

    void warn_of_failure(const ComparedRecipe& recipe, const Options& options, const char* reason) {
        failure_ = std::current_exception();
        const bool is_first = options.vertices == recipe.options.vertices;
        context_.write_log(LogLevel::warning,
                           fmt::format("{} found no valid mesh and {}: {}", recipe.name,
                                       is_first ? "is left out" : "stays as it was", reason));
    }

    /// Where a method needs more vertices than were wanted, as for want of room for its
    /// singularities, the others are made again with as many: finer quads are closer to any
    /// surface.
    void even_out_counts() {
        constexpr int most_rounds = 3;
        constexpr double allowed = 0.05;
        for (int round = 0; round < most_rounds; ++round) {
            int most = 0;
            std::string_view largest;
            for (const std::optional<Contestant>& contestant : made_) {
                if (!contestant || contestant->vertices <= most) continue;
                most = contestant->vertices;
                largest = contestant->method.name;
            }
            bool is_even = true;
            for (std::size_t i = 0; i < made_.size(); ++i) {
                if (!made_[i] || made_[i]->vertices >= (1 - allowed) * most) continue;
                const ComparedRecipe& recipe = options_.recipes[i];
                context_.write_log(
                    LogLevel::warning,
                    fmt::format("{} is made again with {} vertices instead of {}: {} needs as many",
                                recipe.name, most, made_[i]->vertices, largest));
                Options options = recipe.options;
                options.vertices = most;
                options.edge_length = 0;
                if (std::optional<Contestant> again = make(recipe, options)) {
                    is_even = false;
                    made_[i] = std::move(again);
                }
            }
            if (is_even) return;
        }
    }

    void carry(const ForeignMesh& mesh) {
        const auto points = bind_to_surface(mesh.X, reference_, source_.triangles(), context_);
        warn_if_elsewhere(mesh, carried_positions(points, reference_, source_.triangles()));
        add({{mesh.name, "A mesh that was given, carried by the nearest points of the input.", {}},
             follow_surface(mesh.faces, points, source_.triangles()),
             {},
             {},
             static_cast<int>(points.size())});
    }

    /// A mesh in another pose is carried all the same, but what is measured then means nothing.
    void warn_if_elsewhere(const ForeignMesh& mesh, const Positions& on_surface) const {
        const double farthest = std::sqrt((mesh.X - on_surface).rowwise().squaredNorm().maxCoeff());
        const double percent = 100 * farthest / bounding_box_diagonal(reference_);
        if (!(percent > 3)) return;
        context_.write_log(
            LogLevel::warning,
            fmt::format("{}: a vertex is {:.1f} % of the diagonal away from the input; is the mesh "
                        "in the pose of --reference?",
                        mesh.name, percent));
    }

    void add(Contestant contestant) {
        result_.comparison.methods.push_back(std::move(contestant.method));
        result_.meshes.push_back(std::move(contestant.mesh));
        result_.times.push_back(std::move(contestant.times));
        result_.options.push_back(std::move(contestant.options));
    }

    StretchReference quads_over_reference(std::size_t i, const IntrinsicMetric& metric) const {
        const QuadSequence& mesh = result_.meshes[i];
        return {reference_, source_.triangles(), triangle_sides(topology_, metric),
                mesh.read_frame(0, reference_), mesh.faces};
    }

    void measure() {
        topology_ = build_topology(source_.triangles(), source_.vertex_count());
        std::vector<ComparedMethod>& methods = result_.comparison.methods;
        const IntrinsicMetric mean =
            choose_metric(source_, topology_, reference_, MetricChoice::mean, context_);
        const std::optional<SymmetryMap> map =
            find_measuring_map(source_, mean, options_.landmarks, reference_, context_);
        for (std::size_t i = 0; map && i < methods.size(); ++i) {
            methods[i].symmetry_error_degrees =
                measure_symmetry_error(quads_over_reference(i, mean), *map, context_);
        }
        const IntrinsicMetric rest = metric_of(topology_, reference_);
        std::vector<MeasuredQuads> measured;
        for (std::size_t i = 0; i < methods.size(); ++i) {
            measured.push_back({result_.meshes[i], quads_over_reference(i, rest)});
        }
        std::vector<SequenceMetrics> metrics =
            measure_sequences(source_, measured, options_.measure, context_);
        for (std::size_t i = 0; i < methods.size(); ++i) {
            methods[i].metrics = std::move(metrics[i]);
        }
    }

    const FrameSource& source_;
    const ComparisonOptions& options_;
    const Context& context_;
    Positions reference_;
    Topology topology_;
    std::vector<std::optional<Contestant>> made_;  ///< by recipe
    ComparisonResult result_;
    std::exception_ptr failure_;
};

}  // namespace

std::vector<ComparedRecipe> comparison_recipes(const Options& base, bool has_landmarks) {
    // What the paper has: its energy and solver, the lengths of one frame, vertices where the map
    // puts them.
    Options paper = base;
    paper.field = CrossFieldMethod::paper;
    paper.metric = MetricChoice::reference;
    paper.feature_angle = 0;
    paper.relax_rounds = 0;
    paper.alpha = default_alpha(CrossFieldMethod::paper);
    const bool is_symmetric =
        has_landmarks || base.symmetry.value_or(SymmetryMode::none) != SymmetryMode::none;
    paper.symmetry = is_symmetric ? SymmetryMode::field : SymmetryMode::none;

    Options animation_only = paper;
    animation_only.symmetry = SymmetryMode::none;

    Options single_pose = animation_only;
    single_pose.alpha = 0;

    return {
        {"single pose",
         "Mixed-integer quadrangulation of the reference frame alone: no animation, no symmetry.",
         single_pose},
        {"animation only",
         "The paper's baseline: its energy with the stretch of all frames, without symmetry.",
         animation_only, true},
        {"paper",
         is_symmetric ? "The method of Du and Tu to the letter."
                      : "The method of Du and Tu; without landmarks its baseline.",
         paper},
        {"kinequad", "Kinequad with its defaults.", base}};
}

ComparisonResult compare_methods(const FrameSource& source, const ComparisonOptions& options,
                                 const Context& context) {
    require_unique_names(options);
    return MethodComparer(source, options, context).run();
}

}  // namespace kinequad
