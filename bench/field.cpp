// Cost of a cross field on a surface of about the size of a captured character: 20,000 triangles.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "kinequad/field/compute_cross_field.h"

namespace {

using namespace kinequad;

struct Surface {
    Topology topology;
    IntrinsicMetric metric;
    CrossFieldTargets targets;
};

/// A torus of 2 x `around` x `along` triangles with bumps, and targets that turn over it.
Surface bumpy_torus(int around, int along) {
    Positions V(around * along, 3);
    Triangles F(2 * around * along, 3);
    for (int i = 0; i < along; ++i) {
        for (int j = 0; j < around; ++j) {
            const double s = 2 * std::numbers::pi * j / around;
            const double t = 2 * std::numbers::pi * i / along;
            const double small = 0.4 + 0.1 * std::sin(6 * s) * std::cos(3 * t);
            const double r = 1 + small * std::cos(t);
            const int a = i * around + j;
            const int b = i * around + (j + 1) % around;
            const int c = (i + 1) % along * around + (j + 1) % around;
            const int d = (i + 1) % along * around + j;
            V.row(a) << r * std::cos(s), r * std::sin(s), small * std::sin(t);
            F.row(2 * a) << a, b, c;
            F.row(2 * a + 1) << a, c, d;
        }
    }
    Surface surface;
    surface.topology = build_topology(F, static_cast<int>(V.rows()));
    surface.metric = metric_of(surface.topology, V);
    surface.targets.value.resize(F.rows());
    surface.targets.weight = Eigen::VectorXd::Constant(F.rows(), 0.01);
    for (int t = 0; t < F.rows(); ++t) {
        surface.targets.value[t] = std::polar(1.0, 4 * std::sin(V(F(t, 0), 0) * 5));
    }
    return surface;
}

void compute_field(benchmark::State& state) {
    const Surface surface = bumpy_torus(160, 62);
    CrossFieldOptions options;
    options.method = state.range(0) != 0 ? CrossFieldMethod::paper : CrossFieldMethod::convex;
    options.edge_length = 0.07;
    for (auto _ : state) {
        benchmark::DoNotOptimize(
            compute_cross_field(surface.topology, surface.metric, surface.targets, options, {}));
    }
}
BENCHMARK(compute_field)->ArgName("paper")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace
