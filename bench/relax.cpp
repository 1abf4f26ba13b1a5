// Cost of sliding 5,000 quads over a surface of 20,000 triangles, seen in twelve frames.
#include <benchmark/benchmark.h>

#include <cmath>
#include <random>

#include "kinequad/extract/extract_quads.h"
#include "kinequad/io/memory_sequence.h"
#include "kinequad/relax/relax_quads.h"
#include "support/grid_maps.h"
#include "support/shapes.h"

namespace {

using namespace kinequad;

void bench_relax_quads(benchmark::State& state) {
    test::MappedShape shape = test::map_patches(test::torus(100, 100), 1, 100, 100, 70, 70);
    std::mt19937 random(1);
    shape.map = test::jitter_vertices(std::move(shape.map), 0.3, 0, random);
    const QuadMesh quads = extract_quads(shape.map, Context{});
    std::vector<Positions> frames;
    for (int f = 0; f < 12; ++f) {
        Positions frame = shape.mesh.V;
        frame.col(0) += 0.3 * std::sin(0.5 * f) * frame.col(1);
        frames.push_back(std::move(frame));
    }
    const MemorySequence sequence(shape.mesh.F, frames);
    const Topology& topology = shape.map.topology;
    const IntrinsicMetric metric = metric_of(topology, shape.mesh.V);
    for (auto _ : state) {
        benchmark::DoNotOptimize(relax_quads(quads, {{sequence, sequence.read_frame(0)}}, topology,
                                             metric, {}, Context{}));
    }
    state.counters["quads"] = static_cast<double>(quads.Q.rows());
}
BENCHMARK(bench_relax_quads)->Unit(benchmark::kMillisecond);

}  // namespace
