#include "kinequad/field/cross_field_targets.h"

#include <algorithm>
#include <cmath>

#include "kinequad/core/error.h"

namespace kinequad {
namespace {

/// Triangles of a smaller weight ask for nothing.
constexpr double smallest_paper_weight = 0.1;

/// Where in the range of `options` a mean stretch lies, 0 to 1.
double paper_weight(double stretch, const CrossFieldTargetOptions& options) {
    return std::clamp(
        (stretch - options.smallest_stretch) / (options.largest_stretch - options.smallest_stretch),
        0.0, 1.0);
}

void check(const CrossFieldTargetOptions& options, const DeformationTensors& tensors,
           const Topology& topology) {
    const bool paper = options.method == CrossFieldMethod::paper;
    require(std::isfinite(options.alpha) && options.alpha >= 0, InputFault::usage,
            "alpha must not be negative");
    require(!paper || options.alpha < 1, InputFault::usage,
            "alpha must be less than 1 with the paper's field");
    require(!paper || (options.smallest_stretch >= 0 &&
                       options.largest_stretch > options.smallest_stretch),
            InputFault::usage,
            "the stretch of full weight must be above the one of no weight, which must not be "
            "negative");
    require(paper || options.edge_length > 0, InputFault::usage,
            "the wanted edge length must be positive");
    KQ_DEBUG_ASSERT(tensors.stretch_direction_sum.size() == topology.triangle_count);
    static_cast<void>(tensors);
    static_cast<void>(topology);
}

/// Mean stretch over the frames, its modulus bounded by 1: doubling a small stretch doubles what it
/// asks for, doubling a large one hardly does.
Complex bounded_stretch(const DeformationTensors& tensors, Eigen::Index t) {
    if (tensors.frame_count == 0) return 0;
    const Complex mean =
        tensors.stretch_direction_sum[t] / static_cast<double>(tensors.frame_count);
    return mean / (1 + std::abs(mean));
}

}  // namespace

CrossFieldTargets compute_cross_field_targets(const Topology& topology,
                                              const IntrinsicMetric& metric,
                                              const DeformationTensors& tensors,
                                              const CrossFieldTargetOptions& options) {
    check(options, tensors, topology);
    const Eigen::Index count = topology.triangle_count;
    CrossFieldTargets targets{Eigen::VectorXcd::Ones(count), Eigen::VectorXd::Zero(count)};
    const auto set = [&](Eigen::Index t, const Complex& direction, double weight) {
        const double modulus = std::abs(direction);
        if (!(modulus > 0) || !(weight > 0)) return;
        targets.value[t] = direction / modulus;
        targets.weight[t] = weight;
    };
    if (options.method == CrossFieldMethod::paper) {
        const double ratio = options.alpha / (1 - options.alpha);
        for (Eigen::Index t = 0; t < count; ++t) {
            const double sum = tensors.stretch_sum[t];
            if (!(sum > 0)) continue;
            const double weight = paper_weight(tensors.stretch_square_sum[t] / sum, options);
            if (weight < smallest_paper_weight) continue;
            set(t, tensors.stretch_direction_sum[t], ratio * weight);
        }
        return targets;
    }
    const Eigen::VectorXd areas = triangle_areas(topology, metric);
    // A mesh with four triangles a quad was where the factors were measured; hence the 4.
    const double scale = 4 / (options.edge_length * options.edge_length);
    const bool has_curvature = tensors.curvature.size() == count;
    for (Eigen::Index t = 0; t < count; ++t) {
        Complex direction = options.alpha * bounded_stretch(tensors, t);
        if (has_curvature) direction += options.curvature_weight * tensors.curvature[t];
        set(t, direction, scale * areas[t] * std::abs(direction));
    }
    return targets;
}

}  // namespace kinequad
