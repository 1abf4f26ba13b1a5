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

std::vector<SampledFrame> sample_frames(const FrameSource& source, const RelaxOptions& options) {
    const int frames = source.frame_count();
    const int wanted = std::clamp(options.sampled_frames, 1, frames);
    std::vector<SampledFrame> sampled;
    sampled.push_back({options.reference_is_rest_shape ? source.read_rest_shape()
                                                       : source.read_frame(options.reference_frame),
                       0.25 * wanted + 0.75});
    for (int i = 1; i < wanted; ++i) {
        const int frame = static_cast<int>(static_cast<long>(i) * frames / wanted);
        if (!options.reference_is_rest_shape && frame == options.reference_frame) continue;
        sampled.push_back({source.read_frame(frame), 1});
    }
    return sampled;
}

/// Opens folded quads; where the nearest vertices do not do it, ever more of them move. Returns the
/// number that stays folded.
int unfold(SlidingQuads& sliding, int most_passes, const Context& context) {
    int folded = 0;
    for (int pass = 0; pass < most_passes; ++pass) {
        folded = sliding.unfold_pass(pass < releasing_pass ? safe_jacobian : least_jacobian,
                                     pass / 3, context);
        if (folded == 0 && pass > 0) break;
    }
    return folded;
}

/// Alternates what keeps quads unfolded and what keeps the two surfaces together, which are at odds
/// in creases and on tips, and ends with the best state seen: least folded, then closest. Returns
/// the number of quads that stay folded.
int fit(SlidingQuads& sliding, double limit, const ClosestPoints& surface, const Context& context) {
    struct State {
        int folded = 0;
        double distance = 0;
        QuadMesh quads;
    };
    const auto look = [&] {
        return State{sliding.count_folded(), sliding.largest_distance(surface), sliding.quads()};
    };
    unfold(sliding, releasing_pass, context);
    State best = look();
    for (int round = 0; round < fitting_rounds && (best.folded > 0 || best.distance > limit);
         ++round) {
        // Every other round starts from the best state with all vertices free.
        if (round % 2 == 1) sliding.restore(best.quads);
        sliding.hug_surface(limit, 1 + round / 2, surface, context);
        sliding.cover_extremities(limit, context);
        const bool is_last_resort = best.folded > 0 && round >= 2;
        if (is_last_resort) sliding.release();
        unfold(sliding, is_last_resort ? most_unfolding_passes : releasing_pass, context);
        State now = look();
        const bool is_better =
            now.folded != best.folded ? now.folded < best.folded : now.distance < best.distance;
        if (is_better) best = std::move(now);
    }
    sliding.restore(best.quads);
    return best.folded;
}

}  // namespace

QuadMesh relax_quads(const QuadMesh& quads, const FrameSource& source, const Topology& topology,
                     const IntrinsicMetric& metric, const RelaxOptions& options,
                     const Context& context) {
    SlidingQuads sliding(quads, topology, metric, source.triangles(),
                         sample_frames(source, options));
    const double limit = options.distance_limit * sliding.mean_edge_length();
    const ClosestPoints surface(sliding.reference(), source.triangles());
    for (int round = 0; round < options.rounds; ++round) {
        context.report_progress("relaxation", static_cast<double>(round) / options.rounds);
        const bool is_mending = round % 2 == 1 || round + 1 == options.rounds;
        sliding.relax_pass(limit, surface, context);
        if (!is_mending) continue;
        sliding.hug_surface(limit, 0, surface, context);
        sliding.cover_extremities(limit, context);
    }
    const int folded = fit(sliding, limit, surface, context);
    if (folded > 0) {
        context.write_log(
            LogLevel::warning,
            fmt::format("relaxation: {} quads stay folded in the reference frame", folded));
    }
    context.report_progress("relaxation", 1);
    return sliding.quads();
}

}  // namespace kinequad
