#include "kinequad/relax/relax_quads.h"

#include <fmt/format.h>

#include <algorithm>

#include "kinequad/relax/sliding_quads.h"

namespace kinequad {
namespace {

/// Scaled Jacobians below these are mended, in this order: the worst first, then what is close to
/// it.
constexpr double safe_jacobian = 0.15;
constexpr double least_jacobian = 0.05;
constexpr int releasing_pass = 8;
constexpr int most_unfolding_passes = 16;

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
        sliding.relax_pass(context);
        if (!is_mending) continue;
        sliding.hug_surface(limit, surface, context);
        sliding.cover_extremities(limit, context);
    }
    int folded = 0;
    for (int pass = 0; pass < most_unfolding_passes; ++pass) {
        // Where the nearest vertices do not do it, more of them move, and in the end those on extremities.
        if (pass == releasing_pass) sliding.release();
        folded = sliding.unfold_pass(pass < releasing_pass ? safe_jacobian : least_jacobian, pass / 3, context);
        if (folded == 0 && pass > 0) break;
    }
    if (folded > 0) {
        context.write_log(
            LogLevel::warning,
            fmt::format("relaxation: {} quads stay folded in the reference frame", folded));
    }
    context.report_progress("relaxation", 1);
    return sliding.quads();
}

}  // namespace kinequad
