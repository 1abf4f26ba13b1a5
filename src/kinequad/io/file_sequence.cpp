#include "kinequad/io/file_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "kinequad/core/error.h"
#include "kinequad/io/files.h"
#include "kinequad/io/point_cache.h"
#include "kinequad/io/read_obj.h"
#include "kinequad/io/read_polygon_mesh.h"
#include "kinequad/io/triangulate_polygons.h"

namespace kinequad {
namespace {

/// Throws where `frame` is not a frame of the sequence that begins with `first`.
void require_same_faces(const PolygonMesh& frame, int vertex_count, const Polygons& faces,
                        const std::string& name, const std::string& first) {
    if (frame.V.rows() != vertex_count) {
        throw InputError(InputFault::mesh,
                         fmt::format("{}: has {} vertices, but {} has {}; all frames need the same "
                                     "vertices in the same order",
                                     name, frame.V.rows(), first, vertex_count));
    }
    if (frame.faces == faces) return;
    const int common = std::min(frame.faces.count(), faces.count());
    int f = 0;
    while (f < common && std::ranges::equal(frame.faces[f], faces[f])) ++f;
    throw InputError(
        InputFault::mesh,
        fmt::format("{}: its faces differ from those of {}, first at face {} ({} against {} "
                    "faces); all frames need the same faces in the same order",
                    name, first, f, frame.faces.count(), faces.count()));
}

class MeshFiles : public FrameSource {
public:
    MeshFiles(std::vector<std::filesystem::path> files, std::string name)
        : files_(std::move(files)), name_(std::move(name)) {
        const std::string bytes = read_text_file(files_.front());
        PolygonMesh first = parse_polygon_mesh(bytes, files_.front());
        triangles_ = triangulate_polygons(first.V, first.faces);
        vertex_count_ = static_cast<int>(first.V.rows());
        polygons_ = std::move(first.faces);
        if (files_.size() > 1 && extension_of(files_.front()) == ".obj") {
            pattern_ = find_obj_pattern(bytes, name_);
        }
    }

    const Triangles& triangles() const override { return triangles_; }
    Polygons polygons() const override { return polygons_; }
    int vertex_count() const override { return vertex_count_; }
    int frame_count() const override { return static_cast<int>(files_.size()); }
    std::string name() const override { return name_; }

    Positions read_frame(int frame) const override {
        const std::filesystem::path& path = files_.at(static_cast<std::size_t>(frame));
        const std::string bytes = read_text_file(path);
        // The usual sequence differs in its positions only: no need to read the faces again.
        if (!pattern_.tail.empty()) {
            if (auto V = parse_obj_positions(bytes, path.string(), pattern_)) return *std::move(V);
        }
        PolygonMesh mesh = parse_polygon_mesh(bytes, path);
        require_same_faces(mesh, vertex_count_, polygons_, path.string(), files_.front().string());
        return std::move(mesh.V);
    }

private:
    std::vector<std::filesystem::path> files_;
    std::string name_;
    Triangles triangles_;
    Polygons polygons_;
    int vertex_count_ = 0;
    ObjPattern pattern_;
};

void turn_upright(Positions& V, CacheUp up) {
    if (up == CacheUp::as_mesh) return;
    V.col(1).swap(V.col(2));
    V.col(up == CacheUp::y ? 1 : 2) *= -1;
}

class PointCacheSequence : public FrameSource {
public:
    PointCacheSequence(const std::filesystem::path& mesh, const std::filesystem::path& cache,
                       const SequenceOptions& options)
        : cache_(cache), options_(options) {
        PolygonMesh base = read_polygon_mesh(mesh);
        if (base.V.rows() != cache_.points()) {
            throw InputError(
                InputFault::mesh,
                fmt::format("{}: has {} points, but {} has {} vertices; they have to belong "
                            "together",
                            cache_.name(), cache_.points(), mesh.string(), base.V.rows()));
        }
        triangles_ = triangulate_polygons(base.V, base.faces);
        polygons_ = std::move(base.faces);
        rest_ = std::move(base.V);
    }

    const Triangles& triangles() const override { return triangles_; }
    Polygons polygons() const override { return polygons_; }
    int vertex_count() const override { return cache_.points(); }
    int frame_count() const override { return cache_.samples(); }
    std::string name() const override { return cache_.name(); }
    bool has_rest_shape() const override { return true; }
    Positions read_rest_shape() const override { return rest_; }

    Positions read_frame(int frame) const override {
        Positions V = cache_.read_sample(frame);
        turn_upright(V, options_.cache_up);
        return V;
    }

private:
    PointCache cache_;
    SequenceOptions options_;
    Triangles triangles_;
    Polygons polygons_;
    Positions rest_;
};

}  // namespace

std::unique_ptr<FrameSource> open_mesh_files(std::vector<std::filesystem::path> files,
                                             std::string name) {
    return std::make_unique<MeshFiles>(std::move(files), std::move(name));
}

std::unique_ptr<FrameSource> open_point_cache(const std::filesystem::path& mesh,
                                              const std::filesystem::path& cache,
                                              const SequenceOptions& options) {
    return std::make_unique<PointCacheSequence>(mesh, cache, options);
}

}  // namespace kinequad
