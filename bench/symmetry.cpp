// Cost of the symmetry stage on an example creature of about 20,000 triangles.
#include <benchmark/benchmark.h>

#include "kinequad/symmetry/compute_mirror_map.h"
#include "kinequad/symmetry/compute_symmetry_map.h"
#include "kinequad/symmetry/find_mirror_plane.h"
#include "kinequad/synth/synthesize_creature.h"

namespace {

using namespace kinequad;

struct Example {
    TriangleMesh mesh;
    IntrinsicMetric metric;
    Landmarks landmarks;
};

/// A biped of about `triangle_count` triangles: at rest, or in the middle of a step.
Example make_example(int triangle_count, bool at_rest) {
    const auto creature = synthesize_creature("biped", {triangle_count, 8}, {});
    Example example;
    example.mesh = {at_rest ? creature->read_rest_shape() : creature->read_frame(3),
                    creature->triangles()};
    example.metric =
        metric_of(build_topology(example.mesh.F, creature->vertex_count()), example.mesh.V);
    example.landmarks = creature->landmarks();
    return example;
}

void map_from_landmarks(benchmark::State& state) {
    const Example example = make_example(static_cast<int>(state.range(0)), false);
    for (auto _ : state) {
        benchmark::DoNotOptimize(
            compute_symmetry_map(example.mesh, example.metric, example.landmarks, {}, {}));
    }
    state.counters["triangles"] = static_cast<double>(example.mesh.F.rows());
}
BENCHMARK(map_from_landmarks)->Arg(5000)->Arg(20000)->Arg(80000)->Unit(benchmark::kMillisecond);

void map_from_mirror_plane(benchmark::State& state) {
    const Example example = make_example(static_cast<int>(state.range(0)), true);
    for (auto _ : state) {
        const MirrorPlane plane = find_mirror_plane(example.mesh, {});
        benchmark::DoNotOptimize(compute_mirror_map(example.mesh, plane, example.metric, {}));
    }
    state.counters["triangles"] = static_cast<double>(example.mesh.F.rows());
}
BENCHMARK(map_from_mirror_plane)->Arg(20000)->Unit(benchmark::kMillisecond);

}  // namespace
