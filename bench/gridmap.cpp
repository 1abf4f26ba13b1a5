// Cost of the steps from a cross field to an integer-grid map, on a surface of about the size of a
// captured character: 20,000 triangles, 5,000 quads.
#include <benchmark/benchmark.h>

#include <cmath>

#include "kinequad/field/compute_cross_field.h"
#include "kinequad/gridmap/compute_grid_map.h"
#include "kinequad/gridmap/quantize.h"
#include "kinequad/gridmap/seamless_map.h"
#include "support/shapes.h"

namespace {

using namespace kinequad;

struct Input {
    Topology topology;
    IntrinsicMetric metric;
    CrossField field;
};

/// A torus with bumps, which the field has to have singularities for.
Input bumpy_torus(int around, int along, int vertices) {
    TriangleMesh mesh = test::torus(around, along);
    for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
        const Vector3 p = mesh.V.row(v).transpose();
        mesh.V.row(v) *= 1 + 0.2 * std::sin(7 * p[0]) * std::cos(6 * p[1]);
    }
    Input input;
    input.topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    input.metric = metric_of(input.topology, mesh.V);
    const double h = edge_length_for(input.topology, input.metric, vertices);
    input.field =
        compute_cross_field(input.topology, input.metric, {}, {.edge_length = h}, Context{});
    return input;
}

void bench_compute_grid_map(benchmark::State& state) {
    const auto vertices = static_cast<int>(state.range(0));
    const Input input = bumpy_torus(160, 62, vertices);
    const GridMapOptions options{.vertex_count = vertices};
    for (auto _ : state) {
        benchmark::DoNotOptimize(
            compute_grid_map(input.topology, input.metric, input.field, options, Context{}));
    }
    state.counters["singularities"] = static_cast<double>((input.field.index.array() != 0).count());
}
BENCHMARK(bench_compute_grid_map)->Arg(2000)->Arg(5000)->Unit(benchmark::kMillisecond);

/// What the single steps start from.
struct Prepared {
    ChartedMesh mesh;
    MapVariables variables;
    std::vector<TargetShape> shapes;
};

Prepared prepare(const Input& input) {
    Prepared prepared;
    const double h = edge_length_for(input.topology, input.metric, 5000);
    prepared.mesh = build_charts(input.topology, input.metric, input.field, h);
    separate_singularities(prepared.mesh);
    const std::vector<char> nodes = find_nodes(prepared.mesh);
    const CutGraph cut = cut_to_discs(prepared.mesh, nodes);
    prepared.variables = build_map_variables(prepared.mesh, cut, nodes);
    prepared.shapes = target_shapes(prepared.mesh, 1);
    return prepared;
}

void bench_map_variables(benchmark::State& state) {
    const Input input = bumpy_torus(160, 62, 5000);
    for (auto _ : state) benchmark::DoNotOptimize(prepare(input));
}
BENCHMARK(bench_map_variables)->Unit(benchmark::kMillisecond);

void bench_seamless_map(benchmark::State& state) {
    const Prepared map = prepare(bumpy_torus(160, 62, 5000));
    for (auto _ : state) {
        TriangleSystem system(map.variables);
        benchmark::DoNotOptimize(solve_seamless_map(map.variables, system, map.shapes, Context{}));
    }
    state.counters["integers"] = map.variables.integer_count();
}
BENCHMARK(bench_seamless_map)->Unit(benchmark::kMillisecond);

void bench_whole_numbers(benchmark::State& state) {
    const Prepared map = prepare(bumpy_torus(160, 62, 5000));
    TriangleSystem system(map.variables);
    const SeamlessMap seamless = solve_seamless_map(map.variables, system, map.shapes, Context{});
    const std::vector<Complex> corners = map.variables.corner_coordinates(seamless.x);
    for (auto _ : state) {
        const ConeTriangulation cone(map.mesh, map.variables, corners, seamless.integers);
        benchmark::DoNotOptimize(
            quantize(cone, seamless.stiffness, seamless.best_integers, {5000}, Context{}));
    }
}
BENCHMARK(bench_whole_numbers)->Unit(benchmark::kMillisecond);

}  // namespace
