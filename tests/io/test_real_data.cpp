#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "io_support.h"
#include "kinequad/io/open_sequence.h"
#include "kinequad/io/read_polygon_mesh.h"
#include "support/data.h"

namespace kinequad::test {
namespace {

struct Counts {
    std::string name;
    int frames;
    int vertices;
    int triangles;
};

TEST(RealData, SequencesHaveTheirKnownCounts) {
    KINEQUAD_REQUIRE_DATA();
    for (const auto& [name, frames, vertices, triangles] :
         {Counts{"samba", 175, 9971, 19938}, Counts{"bouncing", 175, 10002, 20000},
          Counts{"horse-gallop", 48, 8431, 16843}, Counts{"cat-poses", 9, 7207, 14410},
          Counts{"wolf", 21, 5075, 10018}, Counts{"pjump", 56, 15830, 31660},
          Counts{"chicken", 50, 3030, 5664}, Counts{"makehuman_walk", 60, 13380, 26756},
          Counts{"makehuman_squat", 60, 13380, 26756}, Counts{"CesiumMan", 60, 2338, 4672},
          Counts{"fox", 48, 290, 576}}) {
        SCOPED_TRACE(name);
        const auto source = open_sequence((data_folder() / "sequences" / (name + ".obj")).string());
        EXPECT_EQ(source->frame_count(), frames);
        EXPECT_EQ(source->vertex_count(), vertices);
        EXPECT_EQ(source->triangles().rows(), triangles);
        for (const int f : {0, frames / 2, frames - 1})
            EXPECT_EQ(source->read_frame(f).rows(), vertices);
        ASSERT_TRUE(source->has_rest_shape());
        // The OBJ of all but the MakeHuman sequences holds frame 0, printed with six digits.
        const Positions rest = source->read_rest_shape();
        const double difference = (rest - source->read_frame(0)).cwiseAbs().maxCoeff();
        const double extent = rest.maxCoeff() - rest.minCoeff();
        EXPECT_EQ(difference < 1e-5 * extent, !name.starts_with("makehuman")) << difference;
    }
}

TEST(RealData, HostileFilesAreReadOrRefusedInOneLine) {
    KINEQUAD_REQUIRE_DATA();
    std::vector<std::string> refused;
    for (const auto& entry : std::filesystem::directory_iterator(data_folder() / "hostile")) {
        try {
            const auto source = open_sequence(entry.path().string());
            EXPECT_TRUE(source->read_frame(0).allFinite());
            EXPECT_LT(source->triangles().maxCoeff(), source->vertex_count());
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(entry.path().filename().string()),
                      std::string::npos);
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
            refused.push_back(entry.path().filename().string().substr(0, 2));
        }
    }
    std::sort(refused.begin(), refused.end());
    // NaN, infinity, an index out of range, empty, points only, cut off.
    EXPECT_EQ(refused, (std::vector<std::string>{"02", "03", "17", "22", "23", "35"}));
}

TEST(RealData, StaticMeshesHaveTheirKnownCounts) {
    KINEQUAD_REQUIRE_DATA();
    std::ifstream index(data_folder() / "static/INDEX.tsv");
    std::string line;
    std::getline(index, line);
    int meshes = 0;
    while (std::getline(index, line)) {
        std::istringstream fields(line);
        std::string file;
        int vertices = 0;
        int triangles = 0;
        fields >> file >> vertices >> triangles;
        SCOPED_TRACE(file);
        const auto source = open_sequence((data_folder() / "static" / file).string());
        EXPECT_EQ(source->vertex_count(), vertices);
        EXPECT_EQ(source->triangles().rows(), triangles);
        ++meshes;
    }
    EXPECT_EQ(meshes, 80);
}

TEST(RealData, AnArtistsMeshIsReadAsQuads) {
    KINEQUAD_REQUIRE_DATA();
    const PolygonMesh mesh =
        read_polygon_mesh(data_folder() / "sequences/makehuman_body_quads.obj");
    EXPECT_EQ(mesh.V.rows(), 13380);
    EXPECT_EQ(require_quads(mesh.faces, "makehuman").rows(), 13378);
}

}  // namespace
}  // namespace kinequad::test
