#include <gtest/gtest.h>

#include <random>

#include "io_support.h"
#include "kinequad/io/encode_mesh.h"
#include "kinequad/io/frame_sink.h"
#include "kinequad/io/landmarks.h"
#include "kinequad/io/open_sequence.h"
#include "kinequad/io/point_cache.h"
#include "kinequad/io/read_obj.h"
#include "kinequad/io/read_polygon_mesh.h"
#include "kinequad/io/triangulate_polygons.h"

// Damaged files: a reader either understands what is left or throws InputError, and what it
// returns is a mesh. Run with sanitizers this also shows that no byte outside the input is touched.
namespace kinequad::test {
namespace {

struct Sample {
    std::string file;
    std::string bytes;
};

void require_valid(const PolygonMesh& mesh) {
    ASSERT_GT(mesh.V.rows(), 0);
    ASSERT_GT(mesh.faces.count(), 0);
    ASSERT_TRUE(mesh.V.allFinite());
    for (int f = 0; f < mesh.faces.count(); ++f) {
        ASSERT_GE(mesh.faces[f].size(), 3U);
        for (const int vertex : mesh.faces[f]) {
            ASSERT_GE(vertex, 0);
            ASSERT_LT(vertex, mesh.V.rows());
        }
    }
    const Triangles F = triangulate_polygons(mesh.V, mesh.faces);
    ASSERT_EQ(F.rows(),
              static_cast<Eigen::Index>(mesh.faces.corners.size()) - 2 * mesh.faces.count());
}

/// Reads damaged bytes as what `file` says; true where the reader accepts them.
bool read(const std::string& file, const std::string& bytes) {
    try {
        const std::string extension = extension_of(file);
        if (extension == ".pc2" || extension == ".mdd") {
            const PointCacheLayout layout =
                parse_point_cache_layout(std::string_view(bytes).substr(0, point_cache_head_size),
                                         bytes.size(), extension, file);
            EXPECT_EQ(layout.data_begin + std::uint64_t{12} *
                                              static_cast<std::uint64_t>(layout.points) *
                                              static_cast<std::uint64_t>(layout.samples),
                      bytes.size());
        } else if (extension == ".json") {
            parse_landmarks(bytes, file);
        } else {
            require_valid(parse_polygon_mesh(bytes, file));
        }
        return true;
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).find(file), 0U) << error.what();
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        return false;
    }
}

std::vector<Sample> samples() {
    const Positions V =
        positions_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0.125, -1.5}});
    const Polygons faces = polygons_of({{0, 1, 2, 3}, {1, 4, 2}});
    std::vector<Sample> all = {
        {"a.obj",
         "# c\r\nv\t0 0 0\r\nv 1 0 0 1 1 1\nvn 0 0 1\nv 1 1 0\nv 0 1 0\nv 2 .125 -1.5e0\n"
         "f 1/1/1 2//1 \\\n 3/1 4\nf -4 5 -3\n"},
        {"b.obj", encode_obj_positions(V) + encode_obj_faces(faces)},
        {"a.off", encode_off(V, faces)},
        {"b.ply", encode_ply_header(5, faces) + encode_ply_positions(V) + encode_ply_faces(faces)},
        {"a.ply",
         "ply\nformat ascii 1.0\ncomment c\nelement vertex 3\nproperty float x\nproperty float y\n"
         "property float z\nproperty list uchar int tags\nelement face 1\nproperty list uchar int "
         "vertex_indices\nend_header\n0 0 0 0\n1 0 0 1 5\n0 1 0 2 5 6\n3 0 1 2\n"},
        {"a.stl",
         "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
         "endloop\nendfacet\nendsolid s\n"},
        {"a.json", R"({"pairs": [[4, 7], [0, 1]], "stationary": [9, 10], "names": ["x\u00e4"]})"},
    };
    std::string stl(84 + 2 * 50, '\0');
    stl[80] = 2;
    for (std::size_t k = 100; k < stl.size(); k += 7) stl[k] = static_cast<char>(k % 60);
    all.push_back({"b.stl", stl});
    for (const SequenceFormat format : {SequenceFormat::pc2, SequenceFormat::mdd}) {
        const ScratchFolder folder;
        const auto sink = create_frame_sink(folder.path(), "c", format, faces, 2, V);
        sink->write_frame(0, V);
        sink->write_frame(1, 2 * V);
        sink->finish();
        const auto cache = sink->files().back();
        all.push_back({cache.filename().string(), read_text_file(cache)});
    }
    return all;
}

TEST(DamagedFiles, AreSoundBeforeTheDamage) {
    for (const auto& [file, bytes] : samples()) EXPECT_TRUE(read(file, bytes)) << file;
}

TEST(DamagedFiles, CutOffAtAnyByteAreUnderstoodOrRefused) {
    for (const auto& [file, bytes] : samples()) {
        SCOPED_TRACE(file);
        for (std::size_t size = 0; size < bytes.size(); ++size) {
            const bool accepted = read(file, bytes.substr(0, size));
            // Binary files have no byte to spare.
            if (file == "b.ply" || file == "b.stl" || file == "c.pc2" || file == "c.mdd") {
                EXPECT_FALSE(accepted) << size;
            }
        }
    }
}

TEST(DamagedFiles, WithChangedBytesAreUnderstoodOrRefused) {
    for (const auto& [file, bytes] : samples()) {
        SCOPED_TRACE(file);
        std::mt19937_64 random(20);
        for (int round = 0; round < 2000; ++round) {
            std::string damaged = bytes;
            const std::uint64_t changes = 1 + random() % 4;
            for (std::uint64_t k = 0; k < changes && !damaged.empty(); ++k) {
                const std::size_t at = random() % damaged.size();
                const std::size_t length = 1 + random() % 8;
                switch (random() % 5) {
                    case 0:
                        damaged[at] = static_cast<char>(damaged[at] ^ (1 << (random() % 8)));
                        break;
                    case 1:
                        damaged[at] = static_cast<char>(random() % 256);
                        break;
                    case 2:
                        damaged.erase(at, length);
                        break;
                    case 3:
                        damaged.insert(at, damaged.substr(random() % damaged.size(), length));
                        break;
                    default:
                        damaged[at] = "0123456789-.e/ \n\\#\xff"[random() % 19];
                        break;
                }
            }
            read(file, damaged);
        }
    }
}

TEST(DamagedFiles, QuickReaderOfObjFramesNeverDisagreesWithTheWholeOne) {
    const Sample sample = samples()[1];
    const ObjPattern pattern = find_obj_pattern(sample.bytes, "a.obj");
    const Polygons faces = parse_obj(sample.bytes, "a.obj").faces;
    std::mt19937_64 random(7);
    for (int round = 0; round < 2000; ++round) {
        std::string damaged = sample.bytes;
        damaged[random() % damaged.size()] = "0123456789-.e/ \n\\#fv"[random() % 20];
        std::optional<Positions> quick;
        try {
            quick = parse_obj_positions(damaged, "a.obj", pattern);
        } catch (const InputError&) {
            EXPECT_THROW(parse_obj(damaged, "a.obj"), InputError) << damaged;
            continue;
        }
        if (!quick) continue;
        const PolygonMesh whole = parse_obj(damaged, "a.obj");
        EXPECT_TRUE(same_bits(*quick, whole.V)) << damaged;
        EXPECT_EQ(whole.faces, faces) << damaged;
    }
}

}  // namespace
}  // namespace kinequad::test
