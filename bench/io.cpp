#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>

#include "kinequad/io/encode_mesh.h"
#include "kinequad/io/frame_digest.h"
#include "kinequad/io/frame_sink.h"
#include "kinequad/io/open_sequence.h"
#include "kinequad/io/read_obj.h"
#include "kinequad/io/read_polygon_mesh.h"

namespace {

using namespace kinequad;

/// A folder of its own that is gone with the object.
class ScratchFolder {
public:
    ScratchFolder() {
        std::string pattern =
            (std::filesystem::temp_directory_path() / "kinequad-bench-XXXXXX").string();
        if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no scratch folder");
        path_ = pattern;
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    ~ScratchFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

/// A torus of 100 x 100 vertices and 20,000 triangles, the size of a captured character.
PolygonMesh make_torus() {
    constexpr int n = 100;
    PolygonMesh mesh;
    mesh.V.resize(n * n, 3);
    Triangles F(2 * n * n, 3);
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            const double s = 2 * M_PI * i / n;
            const double t = 2 * M_PI * j / n;
            mesh.V.row(i * n + j) << (2 + std::cos(t)) * std::cos(s),
                (2 + std::cos(t)) * std::sin(s), std::sin(t);
            const int a = i * n + j;
            const int b = i * n + (j + 1) % n;
            const int c = (i + 1) % n * n + (j + 1) % n;
            const int d = (i + 1) % n * n + j;
            F.row(2 * a) << a, b, c;
            F.row(2 * a + 1) << a, c, d;
        }
    }
    mesh.faces = make_polygons(F);
    return mesh;
}

std::string encode_obj(const PolygonMesh& mesh) {
    return encode_obj_positions(mesh.V) + encode_obj_faces(mesh.faces);
}

void BM_ParseObj(benchmark::State& state) {
    const std::string text = encode_obj(make_torus());
    for (auto _ : state) benchmark::DoNotOptimize(parse_obj(text, "torus.obj"));
    state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
}
BENCHMARK(BM_ParseObj)->Unit(benchmark::kMillisecond);

void BM_ParseObjFurtherFrame(benchmark::State& state) {
    const std::string text = encode_obj(make_torus());
    const ObjPattern pattern = find_obj_pattern(text, "torus.obj");
    for (auto _ : state) {
        benchmark::DoNotOptimize(parse_obj_positions(text, "torus.obj", pattern));
    }
    state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
}
BENCHMARK(BM_ParseObjFurtherFrame)->Unit(benchmark::kMillisecond);

void BM_ParseMesh(benchmark::State& state, const std::string& name) {
    const PolygonMesh mesh = make_torus();
    const std::string bytes = name == "torus.off"
                                  ? encode_off(mesh.V, mesh.faces)
                                  : encode_ply_header(static_cast<int>(mesh.V.rows()), mesh.faces) +
                                        encode_ply_positions(mesh.V) + encode_ply_faces(mesh.faces);
    for (auto _ : state) benchmark::DoNotOptimize(parse_polygon_mesh(bytes, name));
    state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes.size()));
}
BENCHMARK_CAPTURE(BM_ParseMesh, off, "torus.off")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_ParseMesh, ply, "torus.ply")->Unit(benchmark::kMillisecond);

void write_torus(const std::filesystem::path& folder, SequenceFormat format,
                 const PolygonMesh& mesh, int frames) {
    const auto sink = create_frame_sink(folder, "torus", format, mesh.faces, frames, mesh.V);
    for (int f = 0; f < frames; ++f) sink->write_frame(f, mesh.V);
    sink->finish();
}

void BM_WriteFrame(benchmark::State& state, SequenceFormat format) {
    constexpr int frames = 20;
    const PolygonMesh mesh = make_torus();
    for (auto _ : state) {
        const ScratchFolder folder;
        write_torus(folder.path(), format, mesh, frames);
    }
    state.SetItemsProcessed(state.iterations() * frames);
}
BENCHMARK_CAPTURE(BM_WriteFrame, obj, SequenceFormat::obj)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_WriteFrame, ply, SequenceFormat::ply)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_WriteFrame, pc2, SequenceFormat::pc2)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_WriteFrame, mdd, SequenceFormat::mdd)->Unit(benchmark::kMillisecond);

void BM_ReadFrame(benchmark::State& state, SequenceFormat format) {
    const ScratchFolder folder;
    write_torus(folder.path(), format, make_torus(), 2);
    const auto source = open_sequence(folder.path().string());
    for (auto _ : state) benchmark::DoNotOptimize(source->read_frame(1));
    state.SetItemsProcessed(state.iterations());
}
BENCHMARK_CAPTURE(BM_ReadFrame, obj, SequenceFormat::obj)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_ReadFrame, ply, SequenceFormat::ply)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_ReadFrame, pc2, SequenceFormat::pc2)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_ReadFrame, mdd, SequenceFormat::mdd)->Unit(benchmark::kMillisecond);

void BM_DigestFrame(benchmark::State& state) {
    const PolygonMesh mesh = make_torus();
    FrameDigest digest(mesh.faces);
    for (auto _ : state) digest.add(0, mesh.V);
    benchmark::DoNotOptimize(digest.value());
    state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_DigestFrame)->Unit(benchmark::kMillisecond);

}  // namespace
