#include "kinequad/deformation/compute_mean_metric.h"

#include <cmath>
#include <vector>

#include "kinequad/core/index.h"
#include "kinequad/core/parallel.h"

namespace kinequad {

IntrinsicMetric compute_mean_metric(const FrameSource& frames, const Topology& topology,
                                    const Context& context) {
    constexpr std::size_t block = 4096;
    const auto edge_count = static_cast<std::size_t>(topology.edge_count);
    std::vector<int> ends(2 * edge_count);
    for (std::size_t e = 0; e < edge_count; ++e) {
        const int h = topology.edge_half_edge[e];
        ends[2 * e] = topology.origin[at(h)];
        ends[2 * e + 1] = topology.target(h);
    }
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(topology.edge_count);
    const int count = frames.frame_count();
    for (int frame = 0; frame < count; ++frame) {
        context.report_progress("mean metric", static_cast<double>(frame) / count);
        const Positions V = frames.read_frame(frame);
        require_extent(V, frame, frames);
        parallel_for(edge_count, block, context, [&](std::size_t begin, std::size_t end) {
            for (std::size_t e = begin; e < end; ++e) {
                const double* a = V.data() + std::ptrdiff_t{3} * ends[2 * e];
                const double* b = V.data() + std::ptrdiff_t{3} * ends[2 * e + 1];
                const double x = b[0] - a[0];
                const double y = b[1] - a[1];
                const double z = b[2] - a[2];
                sum.data()[e] += std::sqrt(x * x + y * y + z * z);
            }
        });
    }
    context.report_progress("mean metric", 1);
    return {sum / count};
}

}  // namespace kinequad
