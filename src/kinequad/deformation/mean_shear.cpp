#include "kinequad/deformation/mean_shear.h"

#include <algorithm>
#include <cmath>

namespace kinequad {

double mean_shear(const Topology& topology, const IntrinsicMetric& from,
                  const IntrinsicMetric& to) {
    // Gram matrix of the two sides that leave corner 0.
    const auto gram = [&](const IntrinsicMetric& metric, int t) {
        const auto sides = side_lengths(topology, metric, t);
        const double a = sides[0] * sides[0];
        const double d = sides[2] * sides[2];
        return Vector3(a, (a + d - sides[1] * sides[1]) / 2, d);
    };
    double sum = 0;
    double area = 0;
    for (int t = 0; t < topology.triangle_count; ++t) {
        const Vector3 g = gram(from, t);
        const Vector3 h = gram(to, t);
        const double det = g[0] * g[2] - g[1] * g[1];
        if (!(det > 0)) continue;
        // Trace and determinant of J^T J are s1^2 + s2^2 and (s1 s2)^2.
        const double trace = (g[2] * h[0] - 2 * g[1] * h[1] + g[0] * h[2]) / det;
        const double ratio = std::max(0.0, h[0] * h[2] - h[1] * h[1]) / det;
        if (!(trace > 0)) continue;
        const double size = std::sqrt(det);
        sum += size * std::sqrt(std::max(0.0, 1 - 4 * ratio / (trace * trace)));
        area += size;
    }
    return area > 0 ? sum / area : 0;
}

MetricComparison compare_metrics(const FrameSource& frames, const Topology& topology,
                                 const IntrinsicMetric& mean, const IntrinsicMetric& reference,
                                 const Context& context) {
    constexpr int most_frames = 24;
    const std::vector<int> chosen = evenly_chosen_frames(frames.frame_count(), most_frames);
    const auto count = static_cast<double>(chosen.size());
    MetricComparison comparison;
    for (const int frame : chosen) {
        context.check_cancelled();
        const IntrinsicMetric here = metric_of(topology, frames.read_frame(frame));
        comparison.gain +=
            (mean_shear(topology, reference, here) - mean_shear(topology, mean, here)) / count;
    }
    comparison.cost = mean_shear(topology, mean, reference);
    return comparison;
}

}  // namespace kinequad
