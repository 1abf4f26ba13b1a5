#include <benchmark/benchmark.h>

#include <cmath>
#include <random>

#include "kinequad/extract/extract_quads.h"
#include "kinequad/extract/quad_topology.h"
#include "kinequad/extract/verify_quad_mesh.h"
#include "support/grid_maps.h"
#include "support/shapes.h"

namespace {

using namespace kinequad;

/// A torus of about `triangles` triangles on about a fifth as many cells, as a character of 25k
/// triangles at 5k quads has, with vertices off the grid.
test::MappedShape torus_of(std::int64_t triangles) {
    const int n = static_cast<int>(std::sqrt(static_cast<double>(triangles) / 2));
    const int cells = static_cast<int>(std::sqrt(static_cast<double>(triangles) / 5));
    test::MappedShape shape = test::map_patches(test::torus(n, n), 1, n, n, cells, cells);
    std::mt19937 random(1);
    shape.map = test::jitter_vertices(std::move(shape.map), 0.3, 0, random);
    return shape;
}

void bench_extract_quads(benchmark::State& state) {
    const test::MappedShape shape = torus_of(state.range(0));
    for (auto _ : state) benchmark::DoNotOptimize(extract_quads(shape.map, Context{}));
    state.counters["triangles"] = static_cast<double>(shape.mesh.F.rows());
}
BENCHMARK(bench_extract_quads)->Arg(25'000)->Arg(250'000)->Unit(benchmark::kMillisecond);

void bench_verify_quad_mesh(benchmark::State& state) {
    const test::MappedShape shape = torus_of(state.range(0));
    const QuadMesh mesh = extract_quads(shape.map, Context{});
    for (auto _ : state) benchmark::DoNotOptimize(verify_quad_mesh(mesh, shape.map.topology));
}
BENCHMARK(bench_verify_quad_mesh)->Arg(25'000)->Unit(benchmark::kMillisecond);

void bench_build_quad_topology(benchmark::State& state) {
    const test::MappedShape shape = torus_of(state.range(0));
    const QuadMesh mesh = extract_quads(shape.map, Context{});
    for (auto _ : state) {
        benchmark::DoNotOptimize(build_quad_topology(mesh.Q, static_cast<int>(mesh.vertex.size())));
    }
}
BENCHMARK(bench_build_quad_topology)->Arg(25'000)->Unit(benchmark::kMillisecond);

}  // namespace
