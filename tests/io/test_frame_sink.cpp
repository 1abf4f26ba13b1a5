#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "io_support.h"
#include "kinequad/io/frame_sink.h"
#include "kinequad/io/open_sequence.h"
#include "kinequad/io/read_polygon_mesh.h"
#include "kinequad/io/write_mesh.h"

namespace kinequad::test {
namespace {

const Polygons faces = polygons_of({{0, 1, 2, 3}, {1, 4, 2}});

Positions frame_of(int f) {
    Positions V = positions_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0.1, -1.0 / 3}});
    V.col(2).array() += 0.1 * f;
    return V;
}

constexpr std::array all_formats = {SequenceFormat::obj, SequenceFormat::ply, SequenceFormat::pc2,
                                    SequenceFormat::mdd};

TEST(FrameSink, WritesWhatOpenSequenceReadsBack) {
    for (const SequenceFormat format : all_formats) {
        const ScratchFolder folder;
        const auto directory = folder / "deep/out";
        const auto sink = create_frame_sink(directory, "quads", format, faces, 12, frame_of(-1));
        for (int f = 0; f < 12; ++f) sink->write_frame(f, frame_of(f));
        EXPECT_THROW(open_sequence(directory.string()), InputError);
        sink->finish();
        const auto source = open_sequence(directory.string());
        ASSERT_EQ(source->frame_count(), 12);
        EXPECT_EQ(source->polygons(), faces);
        const bool is_exact = format == SequenceFormat::obj || format == SequenceFormat::ply;
        for (int f = 0; f < 12; ++f) {
            const Positions expected =
                is_exact ? frame_of(f) : Positions(frame_of(f).cast<float>().cast<double>());
            EXPECT_TRUE(same_bits(source->read_frame(f), expected));
        }
        EXPECT_EQ(source->has_rest_shape(), !is_exact);
        if (!is_exact) {
            EXPECT_TRUE(same_bits(source->read_rest_shape(), frame_of(-1)));
        }
        EXPECT_EQ(sink->files().size(), is_exact ? 12U : 2U);
        for (const auto& file : sink->files()) EXPECT_TRUE(std::filesystem::is_regular_file(file));
    }
}

TEST(FrameSink, LeavesNothingBehindWhenAbandoned) {
    for (const SequenceFormat format : all_formats) {
        const ScratchFolder folder;
        {
            const auto sink = create_frame_sink(folder / "a/b", "q", format, faces, 3, frame_of(0));
            sink->write_frame(0, frame_of(0));
            EXPECT_THROW(sink->finish(), std::logic_error);
        }
        EXPECT_TRUE(folder.entries().empty());
        folder.put("q.obj", "kept");
        folder.put("q_0000.obj", "kept");
        {
            const auto sink = create_frame_sink(folder.path(), "q", format, faces, 3, frame_of(0));
            for (int f = 0; f < 3; ++f) sink->write_frame(f, frame_of(f));
        }
        EXPECT_EQ(folder.entries(), (std::vector<std::string>{"q.obj", "q_0000.obj"}));
        EXPECT_EQ(read_text_file(folder / "q.obj"), "kept");
        EXPECT_EQ(read_text_file(folder / "q_0000.obj"), "kept");
    }
}

TEST(FrameSink, ReplacesAnEarlierRunAndRefusesToMixWithALongerOne) {
    const ScratchFolder folder;
    const auto write = [&](int count) {
        const auto sink =
            create_frame_sink(folder.path(), "q", SequenceFormat::ply, faces, count, frame_of(0));
        for (int f = 0; f < count; ++f) sink->write_frame(f, frame_of(f + count));
        sink->finish();
    };
    write(2);
    write(3);
    EXPECT_TRUE(same_bits(open_sequence(folder.path())->read_frame(0), frame_of(3)));
    expect_input_error([&] { write(2); }, InputFault::file, {"q_0002.ply", "earlier sequence"});
    folder.put("q_body.ply", "another");
    write(3);
}

TEST(FrameSink, RefusesWhatItCannotStore) {
    const ScratchFolder folder;
    Positions bad = frame_of(0);
    bad(2, 1) = std::numeric_limits<double>::infinity();
    Positions huge = frame_of(0);
    huge(2, 1) = -1e300;
    for (const SequenceFormat format : all_formats) {
        const auto sink = create_frame_sink(folder.path(), "q", format, faces, 2, frame_of(0));
        EXPECT_THROW(sink->write_frame(1, frame_of(0)), std::logic_error);
        EXPECT_THROW(sink->write_frame(0, frame_of(0).topRows(3)), std::logic_error);
        expect_input_error([&] { sink->write_frame(0, bad); }, InputFault::mesh,
                           {"frame 0", "not finite"});
        if (format == SequenceFormat::pc2 || format == SequenceFormat::mdd) {
            expect_input_error([&] { sink->write_frame(0, huge); }, InputFault::mesh,
                               {"frame 0", "32-bit"});
        }
    }
    EXPECT_TRUE(folder.entries().empty());
    const std::string file = folder.put("file", "x");
    expect_input_error(
        [&] { create_frame_sink(file, "q", SequenceFormat::obj, faces, 1, frame_of(0)); },
        InputFault::file, {file, "not a folder"});
    expect_input_error(
        [&] { create_frame_sink(file + "/x", "q", SequenceFormat::obj, faces, 1, frame_of(0)); },
        InputFault::file, {file});
}

TEST(FrameSink, KnowsItsFormatsByName) {
    EXPECT_EQ(find_sequence_format("mdd"), SequenceFormat::mdd);
    EXPECT_EQ(find_sequence_format("fbx"), std::nullopt);
}

// Any finite double is the same double after writing and reading, in every mesh format.
RC_GTEST_PROP(WriteMesh, KeepsEveryDouble, (const std::vector<std::uint64_t>& bits)) {
    Positions V = Positions::Zero(static_cast<Eigen::Index>(bits.size()) + 3, 3);
    for (std::size_t i = 0; i < bits.size(); ++i) {
        const auto number = std::bit_cast<double>(bits[i] * 0x9e3779b97f4a7c15U);
        if (std::isfinite(number))
            V(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i % 3)) = number;
    }
    const ScratchFolder folder;
    for (const std::string name : {"a.obj", "a.ply", "a.off"}) {
        write_mesh(folder / name, V, polygons_of({{0, 1, 2}}));
        RC_ASSERT(same_bits(read_polygon_mesh(folder / name).V, V));
    }
}

TEST(WriteMesh, WritesTrianglesQuadsAndLongFaces) {
    const ScratchFolder folder;
    const Positions V = Positions::Random(400, 3);
    Triangles F(1, 3);
    F << 0, 1, 2;
    Quads Q(2, 4);
    Q << 0, 1, 2, 3, 4, 5, 6, 7;
    std::vector<int> all(400);
    for (int k = 0; k < 400; ++k) all[static_cast<std::size_t>(k)] = k;
    for (const std::string name : {"a.obj", "a.ply", "a.off"}) {
        write_mesh(folder / name, V, F);
        EXPECT_EQ(read_polygon_mesh(folder / name).faces, make_polygons(F));
        write_mesh(folder / name, V, Q);
        EXPECT_EQ(require_quads(read_polygon_mesh(folder / name).faces, name), Q);
        write_mesh(folder / name, V, polygons_of({all}));
        EXPECT_EQ(read_polygon_mesh(folder / name).faces, polygons_of({all}));
        expect_input_error([&] { require_quads(read_polygon_mesh(folder / name).faces, name); },
                           InputFault::mesh, {name, "face 0", "400 corners"});
    }
    expect_input_error([&] { write_mesh(folder / "a.fbx", V, F); }, InputFault::usage,
                       {"a.fbx", ".obj"});
}

TEST(WriteFileAtomically, ReplacesTheFileOrLeavesIt) {
    const ScratchFolder folder;
    const std::string path = folder.put("new/a.json", "one");
    EXPECT_EQ(read_text_file(path), "one");
    write_file_atomically(path, "two");
    EXPECT_EQ(read_text_file(path), "two");
    std::filesystem::create_directory(folder / "b");
    expect_input_error([&] { write_file_atomically(folder / "b", "x"); }, InputFault::file,
                       {"/b", "written"});
    EXPECT_EQ(folder.entries(), (std::vector<std::string>{"b", "new"}));
}

}  // namespace
}  // namespace kinequad::test
