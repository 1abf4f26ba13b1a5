#include "kinequad/relax/relax_quads.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "kinequad/relax/sliding_quads.h"

namespace kinequad {
namespace {

/// Scaled Jacobians below these are mended, in this order: the worst first, then what is close to
/// it.
constexpr double safe_jacobian = 0.15;
constexpr double least_jacobian = 0.05;
constexpr int releasing_pass = 8;
constexpr int most_unfolding_passes = 16;
constexpr int fitting_rounds = 10;
constexpr int most_rounds_in_vain = 4;

/// The references, then the other frames.
std::vector<SampledFrame> sample_frames(const std::vector<RelaxView>& views,
                                        const RelaxOptions& options) {
    std::vector<SampledFrame> sampled;
    sampled.reserve(views.size());
    const auto wanted = [&](const RelaxView& view) {
        return std::clamp(options.sampled_frames, 1, view.frames.frame_count());
    };
    for (const RelaxView& view : views) {
        sampled.push_back({view.reference, 0.25 * wanted(view) + 0.75});
    }
    for (const RelaxView& view : views) {
        for (int i = 1; i < wanted(view); ++i) {
            const int frame =
                static_cast<int>(static_cast<long>(i) * view.frames.frame_count() / wanted(view));
            if (options.reference_frame == frame) continue;
            sampled.push_back({view.frames.read_frame(frame), 1});
        }
    }
    return sampled;
}

/// Opens folded quads; where the nearest vertices do not do it, ever more of them move.
void unfold(SlidingQuads& sliding, int most_passes, const Context& context) {
    for (int pass = 0; pass < most_passes; ++pass) {
        const double safe = pass < releasing_pass ? safe_jacobian : least_jacobian;
        const int folded = sliding.unfold_pass(safe, safe, pass / 3, context);
        if (folded == 0 && pass > 0) break;
    }
}

/// Quads at one time, and how good they are.
struct Fit {
    int folded = 0;
    std::vector<double> distances;  ///< q: see `SlidingQuads::distances`
    double distance = 0;            ///< the largest of them
    SlidingQuads::State quads;
};

Fit look_at(const SlidingQuads& sliding) {
    Fit fit{sliding.count_folded(), sliding.distances(), 0, sliding.state()};
    for (const double distance : fit.distances) fit.distance = std::max(fit.distance, distance);
    return fit;
}

/// Alternates what keeps quads unfolded and what keeps the two surfaces together, which are at odds
/// in creases and on tips, and ends with the best state seen: least folded, then closest.
Fit fit_surface(SlidingQuads& sliding, double limit, const Context& context) {
    const auto is_better = [](const Fit& a, const Fit& b) {
        return a.folded != b.folded ? a.folded < b.folded : a.distance < b.distance;
    };
    unfold(sliding, releasing_pass, context);
    Fit best = look_at(sliding);
    int rounds_in_vain = 0;
    for (int round = 0; round < fitting_rounds && rounds_in_vain < most_rounds_in_vain &&
                        (best.folded > 0 || best.distance > limit);
         ++round) {
        // Every other round starts from the best state with all vertices free.
        if (round % 2 == 1) {
            sliding.restore(best.quads);
            sliding.release();
        }
        sliding.hug_surface(limit, 1 + round / 2, context);
        sliding.cover_extremities(limit, context);
        const bool is_last_resort = best.folded > 0 && round >= 2;
        if (is_last_resort) sliding.release();
        unfold(sliding, is_last_resort ? most_unfolding_passes : releasing_pass, context);
        Fit now = look_at(sliding);
        ++rounds_in_vain;
        if (!is_better(now, best)) continue;
        if (now.folded < best.folded || now.distance < 0.9 * best.distance) rounds_in_vain = 0;
        best = std::move(now);
    }
    sliding.restore(best.quads);
    return best;
}

/// Takes back what `fit_surface` had to give up for `best`, as far as it can: vertices go on
/// towards right angles, but for those of quads that are about to leave the surface. A pass that
/// lets a quad leave it is undone, and that quad held. Returns the number of folded quads.
int settle(SlidingQuads& sliding, Fit best, double limit, int rounds, const Context& context) {
    constexpr double held_share = 0.7;
    const auto hold_beyond = [&](const std::vector<double>& distances, double distance) {
        for (std::size_t q = 0; q < distances.size(); ++q) {
            if (distances[q] > distance) sliding.hold(static_cast<int>(q));
        }
    };
    const double allowed = std::max(limit, best.distance);
    for (int round = 0; round < rounds; ++round) {
        hold_beyond(best.distances, held_share * limit);
        sliding.relax_pass(SlidingQuads::Aim::right_angles, limit, context);
        Fit now = look_at(sliding);
        if (now.folded > best.folded || now.distance > allowed) {
            hold_beyond(now.distances, allowed);
            best.quads.is_pinned = sliding.state().is_pinned;
            sliding.restore(best.quads);
            continue;
        }
        best = std::move(now);
    }
    return best.folded;
}

}  // namespace

QuadMesh relax_quads(const QuadMesh& quads, const std::vector<RelaxView>& views,
                     const Topology& topology, const IntrinsicMetric& metric,
                     const RelaxOptions& options, const Context& context) {
    SlidingQuads sliding(quads, topology, metric, views.front().frames.triangles(),
                         sample_frames(views, options), static_cast<int>(views.size()));
    sliding.let_slide(options.line_edges);
    const double limit = options.distance_limit * sliding.mean_edge_length();
    const int square_rounds = options.rounds;
    const int angle_rounds = options.rounds + options.rounds / 2;
    for (int round = 0; round < square_rounds + angle_rounds; ++round) {
        context.report_progress("relaxation",
                                static_cast<double>(round) / (square_rounds + angle_rounds));
        const bool is_for_squares = round < square_rounds;
        sliding.relax_pass(
            is_for_squares ? SlidingQuads::Aim::squares : SlidingQuads::Aim::right_angles, limit,
            context);
        const int mending_interval = is_for_squares ? 2 : 4;
        if ((round + 1) % mending_interval != 0 && round + 1 != square_rounds) continue;
        sliding.hug_surface(limit, 0, context);
        sliding.cover_extremities(limit, context);
    }
    const int folded =
        settle(sliding, fit_surface(sliding, limit, context), limit, options.rounds, context);
    if (folded > 0) {
        context.write_log(
            LogLevel::warning,
            fmt::format("relaxation: {} quads stay folded in the reference frame", folded));
    }
    context.report_progress("relaxation", 1);
    return sliding.quads();
}

}  // namespace kinequad
