// Cost of pictures and of the report's page: a mesh of 5,200 quads at 1920 x 1080, on one thread.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "kinequad/report/camera.h"
#include "kinequad/report/format_report.h"
#include "kinequad/report/render_mesh.h"
#include "kinequad/report/write_png.h"

namespace {

using namespace kinequad;

/// A torus of `around` x `along` quads with a few dots.
RenderScene quad_torus(int around, int along) {
    RenderScene scene;
    scene.V.resize(around * along, 3);
    scene.polygons.resize(around * along, 4);
    for (int i = 0; i < along; ++i) {
        for (int j = 0; j < around; ++j) {
            const double s = 2 * std::numbers::pi * j / around;
            const double t = 2 * std::numbers::pi * i / along;
            const double r = 1 + 0.4 * std::cos(t);
            scene.V.row(i * around + j) << r * std::cos(s), r * std::sin(s), 0.4 * std::sin(t);
            const int i1 = (i + 1) % along;
            const int j1 = (j + 1) % around;
            scene.polygons.row(i * around + j) << i * around + j, i * around + j1, i1 * around + j1,
                i1 * around + j;
        }
    }
    for (int k = 0; k < 50; ++k) scene.markers.push_back({100 * k, Color(0.86, 0.1, 0.1)});
    return scene;
}

Context single_thread() {
    Context context;
    context.threads = 1;
    return context;
}

Image torus_picture() {
    const RenderScene scene = quad_torus(115, 45);
    return render_mesh(scene, fit_camera(scene.V, named_viewpoint("quarter")), RenderOptions{},
                       single_thread());
}

void render_picture(benchmark::State& state) {
    const RenderScene scene = quad_torus(115, 45);
    const Camera camera = fit_camera(scene.V, named_viewpoint("quarter"));
    for (auto _ : state) {
        benchmark::DoNotOptimize(render_mesh(scene, camera, RenderOptions{}, single_thread()));
    }
}

void encode_picture(benchmark::State& state) {
    const Image image = torus_picture();
    for (auto _ : state) benchmark::DoNotOptimize(encode_png(image));
}

void format_page(benchmark::State& state) {
    Report report;
    report.title = "torus";
    for (const char* name : {"one", "two", "three", "four"}) {
        ComparedMethod method{name, "A method.", {}};
        for (int j = 0; j < 175; ++j) method.metrics.frames.emplace_back().frame = j;
        report.comparison.methods.push_back(std::move(method));
    }
    for (auto _ : state) benchmark::DoNotOptimize(format_report(report));
}

BENCHMARK(render_picture)->Unit(benchmark::kMillisecond);
BENCHMARK(encode_picture)->Unit(benchmark::kMillisecond);
BENCHMARK(format_page)->Unit(benchmark::kMillisecond);

}  // namespace
