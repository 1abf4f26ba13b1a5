#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "io_support.h"
#include "kinequad/io/byte_order.h"
#include "kinequad/io/frame_digest.h"
#include "kinequad/io/memory_sequence.h"
#include "kinequad/io/natural_order.h"
#include "kinequad/io/open_sequence.h"
#include "kinequad/io/write_mesh.h"

namespace kinequad::test {
namespace {

std::string obj_frame(double height, const std::string& faces = "f 1 2 3 4\n") {
    return "v 0 0 " + std::to_string(height) + "\nv 1 0 0\nv 1 2 0\nv 0 2 0\n" + faces;
}

std::string pc2(int points, int samples, const std::vector<float>& numbers) {
    std::string bytes("POINTCACHE2\0", 12);
    bytes.resize(32);
    store_number(bytes.data() + 12, 1, std::endian::little);
    store_number(bytes.data() + 16, points, std::endian::little);
    store_number(bytes.data() + 28, samples, std::endian::little);
    for (const float number : numbers) {
        bytes.resize(bytes.size() + 4);
        store_number(bytes.data() + bytes.size() - 4, number, std::endian::little);
    }
    return bytes;
}

std::string mdd(int points, int samples, const std::vector<float>& numbers) {
    std::string bytes(8 + 4 * static_cast<std::size_t>(std::max(samples, 0)), '\0');
    store_number(bytes.data(), samples, std::endian::big);
    store_number(bytes.data() + 4, points, std::endian::big);
    for (const float number : numbers) {
        bytes.resize(bytes.size() + 4);
        store_number(bytes.data() + bytes.size() - 4, number, std::endian::big);
    }
    return bytes;
}

const std::string triangle_obj = "v 9 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const std::vector<float> two_samples = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 5, 1, 2, 3, 0, 1, 0};

void expect_sequence_fault(const std::string& input, InputFault fault,
                           const std::vector<std::string>& parts) {
    expect_input_error(
        [&] {
            const auto source = open_sequence(input);
            for (int f = 0; f < source->frame_count(); ++f) source->read_frame(f);
        },
        fault, parts);
}

TEST(NaturalOrder, ComparesRunsOfDigitsAsNumbers) {
    const std::vector<std::string> ordered = {"a",
                                              "a1",
                                              "a01",
                                              "a2",
                                              "a2b",
                                              "a10",
                                              "a10b1",
                                              "a10b2",
                                              "a010c",
                                              "b",
                                              "b99999999999999999999",
                                              "b100000000000000000000",
                                              "\xc3\xa4"};
    for (std::size_t i = 0; i < ordered.size(); ++i) {
        EXPECT_FALSE(is_naturally_before(ordered[i], ordered[i]));
        for (std::size_t j = i + 1; j < ordered.size(); ++j) {
            if (ordered[i] == "a1" && ordered[j] == "a01") continue;
            EXPECT_TRUE(is_naturally_before(ordered[i], ordered[j]))
                << ordered[i] << " " << ordered[j];
            EXPECT_FALSE(is_naturally_before(ordered[j], ordered[i]))
                << ordered[i] << " " << ordered[j];
        }
    }
    EXPECT_NE(is_naturally_before("a1", "a01"), is_naturally_before("a01", "a1"));
}

TEST(OpenSequence, TakesTheFramesOfAFolderInNaturalOrder) {
    const ScratchFolder folder;
    for (const int f : {10, 2, 1}) folder.put("frame" + std::to_string(f) + ".obj", obj_frame(f));
    folder.put("frame1.mtl", "x");
    folder.put(".frame0.obj", "x");
    for (const std::string& input :
         {folder.path(), folder.path() + "/frame*.obj", folder.path() + "/*"}) {
        const auto source = open_sequence(input);
        ASSERT_EQ(source->frame_count(), 3) << input;
        EXPECT_EQ(source->vertex_count(), 4);
        EXPECT_EQ(source->triangles().rows(), 2);
        EXPECT_EQ(source->polygons(), polygons_of({{0, 1, 2, 3}}));
        EXPECT_FALSE(source->has_rest_shape());
        EXPECT_EQ(source->read_frame(0)(0, 2), 1);
        EXPECT_EQ(source->read_frame(1)(0, 2), 2);
        EXPECT_EQ(source->read_frame(2)(0, 2), 10);
    }
    EXPECT_EQ(open_sequence(folder.path() + "/frame?.obj")->frame_count(), 2);
    EXPECT_EQ(open_sequence(folder.path() + "/frame[2-9].obj")->frame_count(), 1);
}

TEST(OpenSequence, CutsPolygonsAsTheFirstFrameDecides) {
    const ScratchFolder folder;
    folder.put("0.obj", "v 0 0 0\nv 2 0 0\nv 3 1 0\nv 1 1 0\nf 1 2 3 4\n");
    folder.put("1.obj", "v 1 0 0\nv 3 0 0\nv 2 1 0\nv 0 1 0\nf 1 2 3 4\n");
    Triangles expected(2, 3);
    expected << 0, 1, 3, 1, 2, 3;
    EXPECT_EQ(open_sequence(folder.path())->triangles(), expected);
}

TEST(OpenSequence, ReadsFramesWhoseFacesAreWrittenDifferently) {
    const ScratchFolder folder;
    folder.put("0.obj", obj_frame(0));
    folder.put("1.obj", obj_frame(1, "vn 0 0 1\nf 1//1 2//1 3//1 4//1\n"));
    folder.put("2.obj", obj_frame(2, "f -4 -3 -2 -1"));
    const auto source = open_sequence(folder.path());
    for (int f = 0; f < 3; ++f) EXPECT_EQ(source->read_frame(f)(0, 2), f);
}

TEST(OpenSequence, RefusesFramesThatAreNotOfTheSequence) {
    const ScratchFolder folder;
    folder.put("0.obj", obj_frame(0));
    const std::string other = folder.put("1.obj", obj_frame(1, "f 2 3 4 1\n"));
    expect_sequence_fault(folder.path(), InputFault::mesh,
                          {"1.obj", "faces differ", "face 0", "0.obj"});
    folder.put("1.obj", obj_frame(1, "f 1 2 3\nf 1 3 4\n"));
    expect_sequence_fault(folder.path(), InputFault::mesh,
                          {"1.obj", "faces differ", "2 against 1"});
    folder.put("1.obj", "v 0 0 0\n" + obj_frame(1));
    expect_sequence_fault(folder.path(), InputFault::mesh, {"1.obj", "5 vertices", "has 4"});
    folder.put("1.obj", "v 0 0 nan\nv 1 0 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4\n");
    expect_sequence_fault(folder.path(), InputFault::mesh, {"1.obj:1:", "vertex 0"});
    folder.put("1.obj", "");
    expect_sequence_fault(folder.path(), InputFault::file, {"1.obj", "empty"});
    folder.put("1.ply", "ply\n");
    expect_sequence_fault(folder.path(), InputFault::file, {"both .obj and .ply", "name one kind"});
    expect_sequence_fault(folder.path() + "/*.off", InputFault::file, {"*.off", "matches no file"});
    expect_sequence_fault(folder.path() + "/none.obj", InputFault::file,
                          {"none.obj", "does not exist"});
    const ScratchFolder empty;
    expect_sequence_fault(empty.path(), InputFault::file, {empty.path(), "OBJ, PLY or OFF"});
    empty.put("a.stl", "solid");
    empty.put("b.stl", "solid");
    expect_sequence_fault(empty.path(), InputFault::file, {"STL"});
}

TEST(OpenSequence, TakesTheSamplesOfACacheBesideAnObj) {
    for (const std::string extension : {".pc2", ".mdd"}) {
        const ScratchFolder folder;
        const std::string mesh = folder.put("a.obj", triangle_obj);
        const std::string cache = folder.put(
            "a" + extension, extension == ".pc2" ? pc2(3, 2, two_samples) : mdd(3, 2, two_samples));
        for (const std::string& input : {mesh, cache, folder.path(), folder.path() + "/a.*"}) {
            const auto source = open_sequence(input);
            ASSERT_EQ(source->frame_count(), 2) << input;
            ASSERT_EQ(source->vertex_count(), 3);
            EXPECT_TRUE(
                same_bits(source->read_frame(0), positions_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})));
            EXPECT_TRUE(
                same_bits(source->read_frame(1), positions_of({{0, 0, 5}, {1, 2, 3}, {0, 1, 0}})));
            EXPECT_TRUE(source->has_rest_shape());
            EXPECT_EQ(source->read_rest_shape()(0, 0), 9);
        }
        EXPECT_EQ(open_sequence(cache, {CacheUp::y})->read_frame(1).row(1),
                  Eigen::RowVector3d(1, -3, 2));
        EXPECT_EQ(open_sequence(cache, {CacheUp::z})->read_frame(1).row(1),
                  Eigen::RowVector3d(1, 3, -2));
    }
}

TEST(OpenSequence, RefusesCachesThatDoNotFit) {
    const ScratchFolder folder;
    folder.put("a.obj", triangle_obj);
    const auto refuse = [&](const std::string& name, const std::string& bytes, InputFault fault,
                            const std::vector<std::string>& parts) {
        const std::string cache = folder.put(name, bytes);
        expect_sequence_fault(cache, fault, parts);
        std::filesystem::remove(cache);
    };
    const std::string good = pc2(3, 2, two_samples);
    refuse("a.pc2", good.substr(0, good.size() - 1), InputFault::file,
           {"a.pc2", "2 samples of 3", "cut off"});
    refuse("a.pc2", good + "x", InputFault::file, {"a.pc2", "does not fit"});
    refuse("a.pc2", good.substr(0, 31), InputFault::file, {"a.pc2", "header"});
    refuse("a.pc2", "POINTCACHE3" + good.substr(11), InputFault::file, {"a.pc2", "POINTCACHE2"});
    refuse("a.pc2", "", InputFault::file, {"a.pc2", "empty"});
    refuse("a.pc2", pc2(0x7fffffff, 0x7fffffff, two_samples), InputFault::file,
           {"a.pc2", "does not fit"});
    // 12 * 2^60 bytes wrap around 64 bits: such a product must not look right.
    refuse("a.pc2", pc2(1 << 30, 1 << 30, {}), InputFault::file, {"does not fit"});
    refuse("a.pc2", pc2(-3, 2, two_samples), InputFault::file, {"-3 points"});
    refuse("a.pc2", pc2(3, 0, {}), InputFault::file, {"0 samples"});
    refuse("a.pc2", pc2(2, 3, two_samples), InputFault::mesh,
           {"a.pc2", "2 points", "a.obj", "3 vertices"});
    std::vector<float> bad = two_samples;
    bad[13] = std::numeric_limits<float>::infinity();
    refuse("a.pc2", pc2(3, 2, bad), InputFault::mesh, {"a.pc2", "vertex 1", "sample 1"});
    const std::string good_mdd = mdd(3, 2, two_samples);
    refuse("a.mdd", good_mdd.substr(0, good_mdd.size() - 4), InputFault::file,
           {"a.mdd", "cut off"});
    refuse("a.mdd", good_mdd.substr(0, 7), InputFault::file, {"a.mdd", "header"});
    refuse("a.mdd", mdd(-1, 2, {}), InputFault::file, {"a.mdd", "-1 points"});
    refuse("b.pc2", good, InputFault::file, {"b.pc2", "OBJ"});
}

TEST(OpenSequence, AsksWhichSequenceIsMeant) {
    const ScratchFolder folder;
    folder.put("a.obj", triangle_obj);
    folder.put("a.pc2", pc2(3, 2, two_samples));
    folder.put("a.mdd", mdd(3, 2, two_samples));
    expect_sequence_fault((folder / "a.obj").string(), InputFault::file,
                          {"a.pc2", "a.mdd", "name the one"});
    expect_sequence_fault(folder.path(), InputFault::file, {"among other sequences"});
    std::filesystem::remove(folder / "a.mdd");
    folder.put("b.obj", triangle_obj);
    expect_sequence_fault(folder.path(), InputFault::file, {"a.pc2", "among other sequences"});
    EXPECT_EQ(open_sequence((folder / "b.obj").string())->frame_count(), 1);
}

TEST(OpenSequence, TakesOneMeshAsASequenceOfOne) {
    const ScratchFolder folder;
    for (const std::string name : {"a.obj", "a.ply", "a.off"}) {
        const Positions V = positions_of({{0, 0, 0}, {0.1, 0, 0}, {0, 1e-300, 0}});
        write_mesh(folder / name, V, polygons_of({{0, 1, 2}}));
        const auto source = open_sequence((folder / name).string());
        EXPECT_EQ(source->frame_count(), 1);
        EXPECT_TRUE(same_bits(source->read_frame(0), V));
        EXPECT_TRUE(same_bits(source->read_rest_shape(), V));
    }
}

TEST(MemorySequence, HandsOutItsFramesAndChecksThem) {
    const Positions V = positions_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    Triangles F(1, 3);
    F << 0, 1, 2;
    const MemorySequence plain(F, {V, 2 * V});
    EXPECT_EQ(plain.frame_count(), 2);
    EXPECT_EQ(plain.polygons(), polygons_of({{0, 1, 2}}));
    EXPECT_FALSE(plain.has_rest_shape());
    EXPECT_TRUE(same_bits(plain.read_frame(1), 2 * V));
    EXPECT_TRUE(MemorySequence(F, {V}, 3 * V).has_rest_shape());
    const Positions two = V.topRows(2);
    Triangles outside = F;
    outside(0, 2) = 3;
    Positions bad = V;
    bad(1, 1) = std::numeric_limits<double>::quiet_NaN();
    expect_input_error([&] { MemorySequence(F, {}); }, InputFault::mesh, {"no frames"});
    expect_input_error(
        [&] {
            MemorySequence(F, {V, two});
        },
        InputFault::mesh, {"frame 1", "2 vertices"});
    expect_input_error(
        [&] {
            MemorySequence(F, {V, bad});
        },
        InputFault::mesh, {"frame 1", "not finite"});
    expect_input_error([&] { MemorySequence(F, {V}, two); }, InputFault::mesh, {"rest shape"});
    expect_input_error([&] { MemorySequence(outside, {V}); }, InputFault::mesh, {"triangle 0"});
}

TEST(EvenlyChosenFrames, AreSpreadFromTheFirstOn) {
    using Frames = std::vector<int>;
    EXPECT_EQ(evenly_chosen_frames(12, 3), (Frames{0, 4, 8}));
    EXPECT_EQ(evenly_chosen_frames(10, 4), (Frames{0, 2, 5, 7}));
    EXPECT_EQ(evenly_chosen_frames(3, 8), (Frames{0, 1, 2}));
    EXPECT_EQ(evenly_chosen_frames(5, 1), Frames{0});
    EXPECT_EQ(evenly_chosen_frames(5, 0), Frames{});
    EXPECT_EQ(evenly_chosen_frames(2'000'000'000, 1000).back(), 1'998'000'000)
        << "products of frames need more than 32 bits";
}

TEST(FrameDigest, DependsOnContentAndNotOnTheOrderOfCalls) {
    const Positions V = positions_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    Positions W = V;
    W(2, 1) = std::nextafter(1.0, 2.0);
    const Polygons faces = polygons_of({{0, 1, 2}});
    const auto digest = [&](const Polygons& p,
                            const std::vector<std::pair<int, Positions>>& frames) {
        FrameDigest d(p);
        for (const auto& [frame, positions] : frames) d.add(frame, positions);
        return d.text();
    };
    const std::string base = digest(faces, {{0, V}, {1, W}});
    EXPECT_EQ(base.size(), 16U);
    EXPECT_EQ(digest(faces, {{1, W}, {0, V}}), base);
    EXPECT_NE(digest(faces, {{0, W}, {1, V}}), base);
    EXPECT_NE(digest(faces, {{0, V}, {1, V}}), base);
    EXPECT_NE(digest(faces, {{0, V}}), base);
    EXPECT_NE(digest(polygons_of({{0, 2, 1}}), {{0, V}, {1, W}}), base);
    Triangles F(1, 3);
    F << 0, 1, 2;
    EXPECT_EQ(compute_digest(MemorySequence(F, {V, W})), base);
}

}  // namespace
}  // namespace kinequad::test
