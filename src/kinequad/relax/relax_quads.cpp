#include "kinequad/relax/relax_quads.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string_view>
#include <utility>

#include "kinequad/core/index.h"
#include "kinequad/relax/sliding_quads.h"

namespace kinequad {
namespace {

/// Scaled Jacobians below these are mended: the first in as many passes as are usual, the other
/// alone where quads stay folded after these.
constexpr double safe_jacobian = 0.15;
constexpr double least_jacobian = 0.05;
constexpr int usual_unfolding_passes = 8;
/// Share of the time that passes before the surface is fitted take, about, and that before quads
/// settle.
constexpr double slide_share = 0.4;
constexpr double fitted_share = 0.5;
constexpr int most_unfolding_passes = 16;
constexpr int most_fitting_rounds = 10;
constexpr int most_rounds_in_vain = 4;
/// What a reference counts more for every frame chosen beside it, until quads settle in all frames.
constexpr double reference_share = 0.25;

/// Some of so many frames, by number, in ascending order.
using FrameChoice = std::function<std::vector<int>(int frame_count)>;

/// At least one.
FrameChoice evenly_chosen(int most) {
    return [most](int count) { return evenly_chosen_frames(count, std::max(most, 1)); };
}

/// The references, then the frames of each view that `choose` gives, but for the reference. These
/// weigh 1, references `share` more for each of them but the first.
std::vector<SampledFrame> sample_frames(const std::vector<RelaxView>& views,
                                        const FrameChoice& choose, double share,
                                        const RelaxOptions& options) {
    std::vector<SampledFrame> sampled;
    sampled.reserve(views.size());
    for (const RelaxView& view : views) {
        const auto count = static_cast<double>(choose(view.frames.frame_count()).size());
        sampled.push_back({view.reference, share * count + 1 - share});
    }
    for (const RelaxView& view : views) {
        for (const int frame : choose(view.frames.frame_count())) {
            if (options.reference_frame == frame) continue;
            sampled.push_back({view.frames.read_frame(frame), 1});
        }
    }
    return sampled;
}

/// `options.watched_frames`: up to `options.shaped_frames` of them, references among these, then,
/// without weight, the rest.
std::vector<SampledFrame> watched_frames(const std::vector<RelaxView>& views,
                                         const RelaxOptions& options) {
    const FrameChoice watched = evenly_chosen(options.watched_frames);
    const FrameChoice shaped = [&](int count) {
        const std::vector<int> all = watched(count);
        std::vector<int> some;
        for (const int i : evenly_chosen(options.shaped_frames)(static_cast<int>(all.size()))) {
            some.push_back(all[at(i)]);
        }
        return some;
    };
    std::vector<SampledFrame> frames = sample_frames(views, shaped, 0, options);
    for (const RelaxView& view : views) {
        const int count = view.frames.frame_count();
        std::vector<int> known = shaped(count);
        if (options.reference_frame) known.push_back(*options.reference_frame);
        for (const int frame : watched(count)) {
            if (std::find(known.begin(), known.end(), frame) != known.end()) continue;
            frames.push_back({view.frames.read_frame(frame), 0});
        }
    }
    return frames;
}

/// Opens folded quads; where the nearest vertices do not do it, ever more of them move.
void unfold(SlidingQuads& sliding, int most_passes, const Context& context) {
    for (int pass = 0; pass < most_passes; ++pass) {
        const double safe = pass < usual_unfolding_passes ? safe_jacobian : least_jacobian;
        const int folded = sliding.unfold_pass(safe, pass / 3, context);
        if (folded == 0 && pass > 0) break;
    }
}

/// A distance in the sum that says how far quads are from the surface: the largest counts above
/// all, but others count, too.
double misfit_of(double distance, double limit) { return std::pow(distance / limit, 8); }

/// Quads at one time, and how good they are.
struct Fit {
    int folded = 0;
    std::vector<char> is_folded;    ///< q: in a reference
    std::vector<double> distances;  ///< q: between the two surfaces
    double distance = 0;            ///< the largest of them
    double misfit = 0;              ///< their sum, see `misfit_of`
    SlidingQuads::State quads;
};

/// The quads as they are, where `distances` (q) are what `limit` limits.
Fit judge(const SlidingQuads& sliding, std::vector<double> distances, double limit) {
    Fit fit;
    fit.distances = std::move(distances);
    for (std::size_t q = 0; q < fit.distances.size(); ++q) {
        fit.is_folded.push_back(sliding.is_folded(static_cast<int>(q)) ? 1 : 0);
        fit.folded += fit.is_folded.back();
        fit.distance = std::max(fit.distance, fit.distances[q]);
        fit.misfit += misfit_of(fit.distances[q], limit);
    }
    fit.quads = sliding.state();
    return fit;
}

/// Puts those regions of the quads, which are `now`, back to what they were in `before` where that
/// was better: less folded, then closer. Returns what comes of it, with distances as they were in
/// the regions.
Fit keep_better_regions(SlidingQuads& sliding, const Fit& before, const Fit& now, double limit) {
    std::vector<double> distances = now.distances;
    for (const std::vector<int>& region : sliding.regions_moved_since(before.quads)) {
        int folded = 0;
        double misfit = 0;
        for (const int q : region) {
            folded += now.is_folded[at(q)] - before.is_folded[at(q)];
            misfit +=
                misfit_of(now.distances[at(q)], limit) - misfit_of(before.distances[at(q)], limit);
        }
        if (folded < 0 || (folded == 0 && misfit < 0)) continue;
        sliding.restore(before.quads, region);
        for (const int q : region) distances[at(q)] = before.distances[at(q)];
    }
    return judge(sliding, std::move(distances), limit);
}

/// Alternates what keeps quads unfolded and what keeps the two surfaces together, which are at odds
/// in creases and on tips, and keeps in every region what is best there.
void fit_surface(SlidingQuads& sliding, double limit, const Context& context) {
    const auto look = [&] { return judge(sliding, sliding.distances(context), limit); };
    unfold(sliding, usual_unfolding_passes, context);
    Fit best = look();
    // One round brings most; more are for quads that stay folded.
    const auto is_done = [&](int round) {
        return best.folded == 0 && (round > 0 || best.distance <= limit);
    };
    int rounds_in_vain = 0;
    for (int round = 0;
         round < most_fitting_rounds && rounds_in_vain < most_rounds_in_vain && !is_done(round);
         ++round) {
        // Every other round goes on from the best quads with all vertices free, the rest from the
        // last ones: what is worse at first may lead farther.
        if (round % 2 == 1) {
            sliding.restore(best.quads);
            sliding.release();
        }
        sliding.hug_surface(limit, 1 + round / 2, context);
        sliding.cover_extremities(limit, context);
        const bool is_last_resort = best.folded > 0 && round >= 2;
        if (is_last_resort) sliding.release();
        unfold(sliding, is_last_resort ? most_unfolding_passes : usual_unfolding_passes, context);
        const SlidingQuads::State last = sliding.state();
        Fit better = keep_better_regions(sliding, best, look(), limit);
        ++rounds_in_vain;
        if (better.folded < best.folded || better.misfit < 0.9 * best.misfit) rounds_in_vain = 0;
        best = std::move(better);
        sliding.restore(last);
    }
    sliding.restore(best.quads);
}

/// Part of a stage whose progress is reported.
struct ProgressSpan {
    std::string_view stage;
    double begin = 0;
    double end = 1;

    void report(double share, const Context& context) const {
        context.report_progress(stage, begin + share * (end - begin));
    }
};

/// Goes back to what quads were `early` at and around those that stay folded or far from the input
/// in some frame, `distances` (q) in units of the limit, and tries from there: vertices that have
/// slid into a crease together do not come out one by one. Returns whether there are any such
/// quads.
bool start_again(SlidingQuads& sliding, const SlidingQuads::State& early,
                 std::vector<double> distances, const GapOptions& gaps, const Context& context) {
    constexpr double far = 1;
    constexpr int reach = 1;
    const Fit before = judge(sliding, std::move(distances), 1);
    std::vector<int> region;
    for (std::size_t q = 0; q < before.distances.size(); ++q) {
        if (before.distances[q] <= far && before.is_folded[q] == 0) continue;
        const std::vector<int> around = sliding.quads_around(static_cast<int>(q), reach);
        region.insert(region.end(), around.begin(), around.end());
    }
    if (region.empty()) return false;
    sliding.restore(early, region);
    sliding.release();
    unfold(sliding, usual_unfolding_passes, context);
    const GapsLeft left = sliding.close_gaps(gaps, context);
    const Fit now = judge(sliding, left.at_quads, 1);
    keep_better_regions(sliding, before, now, 1);
    return true;
}

/// The passes over all vertices while quads settle.
struct SettlingPasses {
    int count = 0;
    int between = 8;          ///< from one closing of gaps to the next
    double held_share = 0.7;  ///< quads farther from the input, in units of the gaps, stay
    bool takes_back = false;  ///< whether quads that end up farther than a unit go back
};

/// Brings quads and input together in all frames, and takes back what that and `fit_surface` have
/// cost: vertices go on towards right angles, but for those of quads that are about to leave the
/// surface, and gaps are closed again after every few passes. Returns what these leave.
GapsLeft settle(SlidingQuads& sliding, double limit, const SettlingPasses& passes,
                const GapOptions& gaps, const ProgressSpan& progress, const Context& context) {
    progress.report(0, context);
    GapsLeft left = sliding.close_gaps(gaps, context);
    SlidingQuads::State before = sliding.state();
    for (int pass = 0; pass < passes.count; ++pass) {
        if (pass % passes.between == 0) {
            before = sliding.state();
            for (std::size_t q = 0; q < left.at_quads.size(); ++q) {
                if (left.at_quads[q] > passes.held_share) sliding.hold(static_cast<int>(q));
            }
        }
        sliding.relax_pass(SlidingQuads::Aim::right_angles, limit, context);
        if ((pass + 1) % passes.between == 0 || pass + 1 == passes.count) {
            left = sliding.close_gaps(gaps, context);
            if (passes.takes_back && start_again(sliding, before, left.at_quads, gaps, context)) {
                left = sliding.close_gaps(gaps, context);
            }
        }
        progress.report(static_cast<double>(pass + 1) / passes.count, context);
    }
    return left;
}

/// Passes over all vertices, towards squares, then towards right angles, with tips covered every
/// few. Returns what the quads were after the first of these.
SlidingQuads::State slide(SlidingQuads& sliding, double limit, int rounds, const Context& context) {
    const int angle_rounds = rounds + rounds / 2;
    SlidingQuads::State early = sliding.state();
    for (int round = 0; round < rounds + angle_rounds; ++round) {
        context.report_progress("relaxation",
                                slide_share * round / static_cast<double>(rounds + angle_rounds));
        const bool is_for_squares = round < rounds;
        sliding.relax_pass(
            is_for_squares ? SlidingQuads::Aim::squares : SlidingQuads::Aim::right_angles, limit,
            context);
        const int mending_interval = is_for_squares ? 2 : 4;
        if ((round + 1) % mending_interval != 0 && round + 1 != rounds) continue;
        // What covers tips now may be better used elsewhere than what did before.
        sliding.release();
        sliding.hug_surface(limit, 0, context);
        sliding.cover_extremities(limit, context);
        if (is_for_squares && round < mending_interval) early = sliding.state();
    }
    return early;
}

/// Whether some view has frames for `settling_frames` that are not sampled anyway.
bool has_more_frames(const std::vector<RelaxView>& views, const RelaxOptions& options) {
    return std::any_of(views.begin(), views.end(), [&](const RelaxView& view) {
        return std::min(options.settling_frames, view.frames.frame_count()) >
               options.sampled_frames;
    });
}

void warn_of_folded(const SlidingQuads& sliding, const Context& context) {
    int folded = 0;
    for (int q = 0; q < static_cast<int>(sliding.quads().Q.rows()); ++q) {
        if (sliding.is_folded(q)) ++folded;
    }
    if (folded == 0) return;
    context.write_log(
        LogLevel::warning,
        fmt::format("relaxation: {} quads stay folded in the reference frame", folded));
}

/// Quads that are to slide over the surface, watched in `frames` of `views`.
SlidingQuads start_sliding(const QuadMesh& quads, std::vector<SampledFrame> frames,
                           const std::vector<RelaxView>& views, const Topology& topology,
                           const IntrinsicMetric& metric, const RelaxOptions& options) {
    SlidingQuads sliding(quads, topology, metric, views.front().frames.triangles(),
                         std::move(frames), static_cast<int>(views.size()));
    sliding.let_slide(options.line_edges);
    return sliding;
}

}  // namespace

QuadMesh relax_quads(const QuadMesh& quads, const std::vector<RelaxView>& views,
                     const Topology& topology, const IntrinsicMetric& metric,
                     const RelaxOptions& options, const Context& context) {
    const auto start = [&](const QuadMesh& from, int frames) {
        return start_sliding(from,
                             sample_frames(views, evenly_chosen(frames), reference_share, options),
                             views, topology, metric, options);
    };
    std::optional<SlidingQuads> sliding(start(quads, options.sampled_frames));
    const double limit = options.distance_limit * sliding->mean_edge_length();
    const SlidingQuads::State early = slide(*sliding, limit, options.rounds, context);
    fit_surface(*sliding, limit, context);
    const GapOptions gaps{.limit = options.gap_limit, .drags_patches = options.drags_patches};
    const auto bring_together = [&](int rounds, double begin, double end) {
        const GapsLeft left =
            settle(*sliding, limit, {rounds}, gaps, {"relaxation", begin, end}, context);
        start_again(*sliding, early, left.at_quads, gaps, context);
    };
    const bool has_more = has_more_frames(views, options);
    const double settled_share = has_more ? (1 + fitted_share) / 2 : 1;
    bring_together(options.rounds, fitted_share, settled_share);
    if (has_more) {
        // The few frames are let go before the many come.
        const QuadMesh settled = sliding->quads();
        sliding.reset();
        sliding.emplace(start(settled, options.settling_frames));
        bring_together(options.settling_rounds, settled_share, 1);
    }
    warn_of_folded(*sliding, context);
    context.report_progress("relaxation", 1);
    return sliding->quads();
}

QuadMesh settle_in_more_frames(const QuadMesh& quads, const std::vector<RelaxView>& views,
                               const Topology& topology, const IntrinsicMetric& metric,
                               const RelaxOptions& options, const Context& context) {
    constexpr double shape_weight = 3;
    constexpr double farthest_shape_weight = 1.8;
    constexpr double longest_stretch = 4;
    constexpr double longest_stretch_at_last = 5;
    constexpr double closable_share = 0.7;
    constexpr double held_share = 0.85;
    constexpr double settled_share = 0.7;
    constexpr double closed_share = 0.8;
    constexpr double few_far = 0.006;
    constexpr double tightening = 0.88;
    constexpr double weight_of_distance = 0.35;
    constexpr double farthest_share = 0.97;
    constexpr double least_limit_share = 0.9;
    const auto start = [&](const QuadMesh& from) {
        return start_sliding(from, watched_frames(views, options), views, topology, metric,
                             options);
    };
    std::optional<SlidingQuads> sliding(start(quads));
    const double limit = options.distance_limit * sliding->mean_edge_length();
    // Where shapes count in fewer frames than distances do, they have to hold their own: above all
    // at first, when most moves.
    const double frames_per_shaped = sliding->frames_per_shaped();
    const auto gaps_within = [&](double unit, double weight) {
        return GapOptions{.limit = unit,
                          .every_frame_counts = true,
                          .drags_patches = options.drags_patches,
                          .shape_weight = weight * frames_per_shaped,
                          .most_stretch = longest_stretch};
    };
    const auto share_of_far = [&](const GapsLeft& left) {
        const auto far = std::count_if(left.at_quads.begin(), left.at_quads.end(),
                                       [](double distance) { return distance > 1; });
        return static_cast<double>(far) / static_cast<double>(quads.Q.rows());
    };
    // Less is better. Angles go with the root of the cost.
    const auto grade = [&](double farthest) {
        return std::sqrt(sliding->shape_cost()) * std::pow(farthest, weight_of_distance);
    };
    // Where quads are too far away for all to come close, those that do not would outweigh shapes.
    const double gap_limit =
        std::max(options.gap_limit, closable_share * sliding->mean_farthest(context));
    const int between = std::max(1, options.watched_rounds / 3);
    const GapsLeft settled =
        settle(*sliding, limit, {options.watched_rounds, between, held_share, true},
               gaps_within(gap_limit, shape_weight * frames_per_shaped),
               {"settling", 0, settled_share}, context);
    // In mean lengths of edges, the largest in a frame, mean over all frames.
    double farthest = settled.mean_farthest * gap_limit;
    // Where nearly nothing is left, a lower limit is reached for.
    if (share_of_far(settled) <= few_far) {
        const double settled_grade = grade(farthest);
        const SlidingQuads::State before = sliding->state();
        const double closing_limit = tightening * gap_limit;
        const GapsLeft left =
            sliding->close_gaps(gaps_within(closing_limit, shape_weight), context);
        const double closed_farthest = left.mean_farthest * closing_limit;
        if (grade(closed_farthest) < settled_grade) {
            farthest = closed_farthest;
        } else {
            sliding->restore(before);
        }
    }
    context.report_progress("settling", closed_share);
    // Lengths of edges are those of now from here on; they have hardly changed in the mean, and
    // `farthest` is taken as if they had not.
    const QuadMesh closed = sliding->quads();
    sliding.reset();
    sliding.emplace(start(closed));
    // The farthest place of a frame says how close it is; these are few.
    GapOptions at_farthest = gaps_within(
        std::max(farthest_share * farthest, least_limit_share * gap_limit), farthest_shape_weight);
    at_farthest.only_farthest = true;
    // Twice: what moves may leave the input between the points that were looked at, and what stays
    // may lie beside edges of the input that no shorter quad lets it come close to.
    for (const double stretch : {longest_stretch, longest_stretch_at_last}) {
        at_farthest.most_stretch = stretch;
        sliding->close_gaps(at_farthest, context);
    }
    context.report_progress("settling", 1);
    return sliding->quads();
}

}  // namespace kinequad
