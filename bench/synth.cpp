// Benchmarks of src/kinequad/synth and of the pictures of src/kinequad/report.
#include <benchmark/benchmark.h>

#include "kinequad/report/render_mesh.h"
#include "kinequad/synth/synthesize_creature.h"

namespace kinequad {
namespace {

void synthesize(benchmark::State& state) {
    const SynthOptions options{static_cast<int>(state.range(0)), 24};
    for (auto _ : state) {
        benchmark::DoNotOptimize(synthesize_creature("biped", options, Context{}));
    }
}
BENCHMARK(synthesize)
    ->Arg(1000)
    ->Arg(20000)
    ->Arg(200000)
    ->Arg(2000000)
    ->Unit(benchmark::kMillisecond);

void pose_frame(benchmark::State& state) {
    const auto creature =
        synthesize_creature("biped", {static_cast<int>(state.range(0)), 24}, Context{});
    int frame = 0;
    for (auto _ : state) {
        benchmark::DoNotOptimize(creature->read_frame(frame));
        frame = (frame + 1) % creature->frame_count();
    }
}
BENCHMARK(pose_frame)->Arg(20000)->Arg(200000)->Unit(benchmark::kMillisecond);

void render_picture(benchmark::State& state) {
    const auto creature =
        synthesize_creature("quadruped", {static_cast<int>(state.range(0)), 24}, Context{});
    RenderScene scene{creature->read_frame(3), polygons_of(creature->triangles()), {}, {}, {}};
    const Camera camera = fit_camera(scene.V, named_viewpoint("quarter"));
    for (auto _ : state) {
        benchmark::DoNotOptimize(render_mesh(scene, camera, RenderOptions{}, Context{}));
    }
}
BENCHMARK(render_picture)->Arg(10000)->Arg(200000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace kinequad
