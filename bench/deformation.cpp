// Cost of analysing a sequence of about the size of a captured character: 20,000 triangles, a
// frame.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "kinequad/deformation/compute_deformation_tensors.h"
#include "kinequad/deformation/compute_mean_metric.h"
#include "kinequad/io/memory_sequence.h"

namespace {

using namespace kinequad;

constexpr int frame_count = 8;

/// A rippled torus of 2 x `around` x `along` triangles that changes its ripples over the frames.
MemorySequence rippled_torus(int around, int along) {
    std::vector<Positions> frames;
    for (int f = 0; f < frame_count; ++f) {
        Positions V(around * along, 3);
        for (int i = 0; i < along; ++i) {
            for (int j = 0; j < around; ++j) {
                const double s = 2 * std::numbers::pi * j / around;
                const double t = 2 * std::numbers::pi * i / along;
                const double small = 0.4 + 0.03 * std::sin(9 * s + f) * std::cos(5 * t - f);
                const double r = 1 + small * std::cos(t);
                V.row(i * around + j) << r * std::cos(s), r * std::sin(s), small * std::sin(t);
            }
        }
        frames.push_back(std::move(V));
    }
    Triangles F(2 * around * along, 3);
    for (int i = 0; i < along; ++i) {
        for (int j = 0; j < around; ++j) {
            const int a = i * around + j;
            const int b = i * around + (j + 1) % around;
            const int c = (i + 1) % along * around + (j + 1) % around;
            const int d = (i + 1) % along * around + j;
            F.row(2 * a) << a, b, c;
            F.row(2 * a + 1) << a, c, d;
        }
    }
    return {F, std::move(frames)};
}

Context single_thread() {
    Context context;
    context.threads = 1;
    return context;
}

void average_lengths(benchmark::State& state) {
    const MemorySequence frames = rippled_torus(160, 62);
    const Topology topology = build_topology(frames.triangles(), frames.vertex_count());
    const Context context = single_thread();
    for (auto _ : state) {
        benchmark::DoNotOptimize(compute_mean_metric(frames, topology, context));
    }
    state.SetItemsProcessed(state.iterations() * frame_count);
}
BENCHMARK(average_lengths)->Unit(benchmark::kMillisecond);

void measure_strain(benchmark::State& state) {
    const MemorySequence frames = rippled_torus(160, 62);
    const Topology topology = build_topology(frames.triangles(), frames.vertex_count());
    const Context context = single_thread();
    const IntrinsicMetric metric = compute_mean_metric(frames, topology, context);
    DeformationOptions options;
    options.edge_length = state.range(0) != 0 ? 0.07 : 0;
    for (auto _ : state) {
        benchmark::DoNotOptimize(
            compute_deformation_tensors(frames, topology, metric, options, context));
    }
    state.SetItemsProcessed(state.iterations() * frame_count);
}
BENCHMARK(measure_strain)->ArgName("curvature")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace
