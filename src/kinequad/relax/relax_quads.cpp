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
constexpr int fitting_rounds = 6;
constexpr int most_rounds_in_vain = 2;
constexpr int settling_rounds = 4;

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

/// Opens folded quads; where the nearest vertices do not do it, ever more of them move. Returns the
/// number that stays folded.
int unfold(SlidingQuads& sliding, int most_passes, const Context& context) {
    int folded = 0;
    for (int pass = 0; pass < most_passes; ++pass) {
        const double safe = pass < releasing_pass ? safe_jacobian : least_jacobian;
        folded = sliding.unfold_pass(safe, safe, pass / 3, context);
        if (folded == 0 && pass > 0) break;
    }
    return folded;
}

/// Alternates what keeps quads unfolded and what keeps the two surfaces together, which are at odds
/// in creases and on tips, and ends with the best state seen: least folded, then closest. Returns
/// the number of quads that stay folded.
int fit(SlidingQuads& sliding, double limit, const Context& context) {
    struct State {
        int folded = 0;
        double distance = 0;
        SlidingQuads::State quads;
    };
    const auto look = [&] {
        return State{sliding.count_folded(), sliding.largest_distance(), sliding.state()};
    };
    const auto is_better = [](const State& a, const State& b) {
        return a.folded != b.folded ? a.folded < b.folded : a.distance < b.distance;
    };
    unfold(sliding, releasing_pass, context);
    State best = look();
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
        State now = look();
        ++rounds_in_vain;
        if (!is_better(now, best)) continue;
        if (now.folded < best.folded || now.distance < 0.9 * best.distance) rounds_in_vain = 0;
        best = std::move(now);
    }
    sliding.restore(best.quads);
    // What has moved away from squares for that comes back as far as it can.
    for (int round = 0; round < settling_rounds; ++round) {
        sliding.relax_pass(limit, context);
        State now = look();
        if (now.folded > best.folded || now.distance > std::max(limit, best.distance)) {
            sliding.restore(best.quads);
            break;
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
    sliding.pin(options.pinned);
    const double limit = options.distance_limit * sliding.mean_edge_length();
    for (int round = 0; round < options.rounds; ++round) {
        context.report_progress("relaxation", static_cast<double>(round) / options.rounds);
        const bool is_mending = round % 2 == 1 || round + 1 == options.rounds;
        sliding.relax_pass(limit, context);
        if (!is_mending) continue;
        sliding.hug_surface(limit, 0, context);
        sliding.cover_extremities(limit, context);
    }
    const int folded = fit(sliding, limit, context);
    if (folded > 0) {
        context.write_log(
            LogLevel::warning,
            fmt::format("relaxation: {} quads stay folded in the reference frame", folded));
    }
    context.report_progress("relaxation", 1);
    return sliding.quads();
}

}  // namespace kinequad
