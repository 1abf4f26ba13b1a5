#include "kinequad/deformation/compute_deformation_tensors.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/core/parallel.h"
#include "kinequad/deformation/frame_curvature.h"
#include "kinequad/deformation/triangle_strain.h"

namespace kinequad {
namespace {

constexpr std::size_t strain_block = 2048;

void check(const DeformationOptions& options, int frame_count) {
    require(options.edge_length >= 0 && std::isfinite(options.edge_length), InputFault::usage,
            "the wanted edge length must not be negative");
    require(options.curvature_frames >= 1, InputFault::usage,
            "the number of frames for the curvature must be at least 1");
    require(options.stretch_quantile > 0 && options.stretch_quantile <= 1, InputFault::usage,
            "the quantile of the stretch must lie in (0, 1]");
    if (options.only_frame && (*options.only_frame < 0 || *options.only_frame >= frame_count)) {
        throw InputError(InputFault::usage,
                         fmt::format("frame {} does not exist; the sequence has {} frames",
                                     *options.only_frame, frame_count));
    }
}

std::vector<int> frames_to_read(const DeformationOptions& options, int frame_count) {
    if (options.only_frame) return {*options.only_frame};
    std::vector<int> result(at(frame_count));
    for (int j = 0; j < frame_count; ++j) result[at(j)] = j;
    return result;
}

/// At most `wanted` of `frames`, in the middles of equal parts.
std::vector<int> choose_evenly(const std::vector<int>& frames, int wanted) {
    const std::size_t count = std::min(frames.size(), at(wanted));
    std::vector<int> result;
    for (std::size_t i = 0; i < count; ++i) {
        result.push_back(frames[(2 * i + 1) * frames.size() / (2 * count)]);
    }
    return result;
}

class Accumulator {
public:
    Accumulator(const Topology& topology, const IntrinsicMetric& metric, const Context& context)
        : topology_(topology),
          context_(context),
          rest_(rest_triangles(topology, metric)),
          sums_(rest_.size()) {}

    /// Stretches of all triangles that frame `V` keeps.
    void append_stretches(const Positions& V, std::vector<double>& stretches) const {
        for (std::size_t t = 0; t < rest_.size(); ++t) {
            const TriangleStrain strain = strain_at(V, t);
            if (strain.valid()) stretches.push_back(strain.stretch());
        }
    }

    void add_frame(const Positions& V, double largest_stretch) {
        parallel_for(rest_.size(), strain_block, context_, [&](std::size_t begin, std::size_t end) {
            for (std::size_t t = begin; t < end; ++t) {
                const TriangleStrain strain = strain_at(V, t);
                if (!strain.valid()) continue;
                Sums& sums = sums_[t];
                const double square = strain.x * strain.x + strain.y * strain.y;
                if (!(square > 0)) continue;
                // The fourth power of the direction, times the squared modulus of the deviator.
                const double re = strain.x * strain.x - strain.y * strain.y;
                const double im = 2 * strain.x * strain.y;
                const double s = std::min(largest_stretch, strain.stretch());
                const double factor = s / square;
                sums.stretch_re += factor * re;
                sums.stretch_im += factor * im;
                sums.stretch += s;
                sums.stretch_square += s * s;
            }
        });
    }

    DeformationTensors result(int frame_count) const {
        const Eigen::Index count = topology_.triangle_count;
        DeformationTensors tensors;
        tensors.frame_count = frame_count;
        tensors.stretch_direction_sum.resize(count);
        tensors.stretch_sum.resize(count);
        tensors.stretch_square_sum.resize(count);
        tensors.curvature = Eigen::VectorXcd::Zero(count);
        for (Eigen::Index t = 0; t < count; ++t) {
            const Sums& sums = sums_[at(t)];
            tensors.stretch_direction_sum[t] = Complex(sums.stretch_re, sums.stretch_im);
            tensors.stretch_sum[t] = sums.stretch;
            tensors.stretch_square_sum[t] = sums.stretch_square;
        }
        return tensors;
    }

private:
    struct Sums {
        double stretch_re = 0, stretch_im = 0, stretch = 0, stretch_square = 0;
    };

    TriangleStrain strain_at(const Positions& V, std::size_t t) const {
        const int* corner = topology_.origin.data() + 3 * t;
        const auto place = [&](int k) { return V.data() + std::ptrdiff_t{3} * corner[k]; };
        return strain_of(rest_[t], place(0), place(1), place(2));
    }

    const Topology& topology_;
    const Context& context_;
    std::vector<RestTriangle> rest_;
    std::vector<Sums> sums_;
};

double quantile_of(std::vector<double>& values, double quantile) {
    if (values.empty()) return std::numeric_limits<double>::infinity();
    const auto rank =
        static_cast<std::ptrdiff_t>(quantile * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return values[at(rank)];
}

}  // namespace

DeformationTensors compute_deformation_tensors(const FrameSource& frames, const Topology& topology,
                                               const IntrinsicMetric& metric,
                                               const DeformationOptions& options,
                                               const Context& context) {
    check(options, frames.frame_count());
    const std::vector<int> all = frames_to_read(options, frames.frame_count());
    const std::vector<int> chosen = choose_evenly(all, options.curvature_frames);
    Accumulator accumulator(topology, metric, context);

    double largest_stretch = std::numeric_limits<double>::infinity();
    Eigen::VectorXcd curvature = Eigen::VectorXcd::Zero(topology.triangle_count);
    const FrameCurvature bend(topology, metric);
    std::vector<double> stretches;
    for (const int frame : chosen) {
        context.check_cancelled();
        const Positions V = frames.read_frame(frame);
        if (options.edge_length > 0) bend.accumulate(V, options.edge_length, context, curvature);
        if (options.stretch_quantile < 1) accumulator.append_stretches(V, stretches);
    }
    if (options.stretch_quantile < 1) {
        largest_stretch = quantile_of(stretches, options.stretch_quantile);
        context.write_log(LogLevel::info,
                          fmt::format("stretches are bounded at {:.4g}, their {:.4g} quantile",
                                      largest_stretch, options.stretch_quantile));
    }
    for (std::size_t i = 0; i < all.size(); ++i) {
        context.report_progress("deformation",
                                static_cast<double>(i) / static_cast<double>(all.size()));
        accumulator.add_frame(frames.read_frame(all[i]), largest_stretch);
    }
    context.report_progress("deformation", 1);
    DeformationTensors tensors = accumulator.result(static_cast<int>(all.size()));
    tensors.curvature = curvature / static_cast<double>(chosen.size());
    return tensors;
}

}  // namespace kinequad
