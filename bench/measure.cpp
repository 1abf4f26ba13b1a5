// Cost of measuring one frame of about the size of a captured character: 20,000 triangles under
// 5,200 quads.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "kinequad/io/polygons.h"
#include "kinequad/measure/quad_shape.h"
#include "kinequad/measure/surface_distance.h"
#include "kinequad/measure/triangulation.h"
#include "kinequad/mesh/closest_points.h"

namespace {

using namespace kinequad;

struct QuadTorus {
    Positions X;
    Quads Q;
};

/// A torus with a rippled surface, moved by `phase`: `around` x `along` quads.
QuadTorus rippled_torus(int around, int along, double phase) {
    QuadTorus torus;
    torus.X.resize(around * along, 3);
    torus.Q.resize(around * along, 4);
    for (int i = 0; i < along; ++i) {
        for (int j = 0; j < around; ++j) {
            const double s = 2 * std::numbers::pi * j / around;
            const double t = 2 * std::numbers::pi * i / along;
            const double small = 0.4 + 0.03 * std::sin(9 * s + phase) * std::cos(5 * t - phase);
            const double r = 1 + small * std::cos(t);
            torus.X.row(i * around + j) << r * std::cos(s), r * std::sin(s), small * std::sin(t);
            const int i1 = (i + 1) % along;
            const int j1 = (j + 1) % around;
            torus.Q.row(i * around + j) << i * around + j, i * around + j1, i1 * around + j1,
                i1 * around + j;
        }
    }
    return torus;
}

TriangleMesh as_triangles(const QuadTorus& torus) {
    return {torus.X, triangulate_for_measuring(make_polygons(torus.Q), torus.X).F};
}

Context single_thread() {
    Context context;
    context.threads = 1;
    return context;
}

void measure_distance_of_a_frame(benchmark::State& state) {
    SurfaceDistanceMeter meter;
    double phase = 0;
    for (auto _ : state) {
        state.PauseTiming();
        const TriangleMesh input = as_triangles(rippled_torus(160, 62, phase));
        const TriangleMesh quads = as_triangles(rippled_torus(115, 45, phase));
        phase += 0.05;
        state.ResumeTiming();
        benchmark::DoNotOptimize(
            meter.measure(ClosestPoints(input.V, input.F), quads, single_thread()));
    }
}

void move_closest_points(benchmark::State& state) {
    const TriangleMesh first = as_triangles(rippled_torus(160, 62, 0));
    const Positions second = rippled_torus(160, 62, 0.05).X;
    ClosestPoints surface(first.V, first.F);
    bool is_first = false;
    for (auto _ : state) {
        surface.update(is_first ? first.V : second, first.F);
        is_first = !is_first;
    }
}

void find_closest_points(benchmark::State& state) {
    const TriangleMesh input = as_triangles(rippled_torus(160, 62, 0));
    const Positions X = rippled_torus(115, 45, 0).X;
    const ClosestPoints surface(input.V, input.F);
    for (auto _ : state) {
        for (Eigen::Index i = 0; i < X.rows(); ++i) {
            benchmark::DoNotOptimize(surface.find(X.row(i).transpose()));
        }
    }
    state.SetItemsProcessed(state.iterations() * X.rows());
}

void measure_shape_of_a_frame(benchmark::State& state) {
    const QuadTorus torus = rippled_torus(115, 45, 0);
    const Polygons faces = make_polygons(torus.Q);
    for (auto _ : state) benchmark::DoNotOptimize(measure_shape(torus.X, faces));
}

BENCHMARK(measure_distance_of_a_frame)->Unit(benchmark::kMillisecond);
BENCHMARK(move_closest_points)->Unit(benchmark::kMillisecond);
BENCHMARK(find_closest_points)->Unit(benchmark::kMillisecond);
BENCHMARK(measure_shape_of_a_frame)->Unit(benchmark::kMillisecond);

}  // namespace
