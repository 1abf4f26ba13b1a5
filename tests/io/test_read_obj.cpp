#include <gtest/gtest.h>

#include "io_support.h"
#include "kinequad/io/read_obj.h"

namespace kinequad::test {
namespace {

PolygonMesh parse(const std::string& text) { return parse_obj(text, "file.obj"); }

void expect_obj_fault(const std::string& text, InputFault fault,
                      const std::vector<std::string>& parts) {
    expect_input_error([&] { parse(text); }, fault, parts);
}

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST(ReadObj, KeepsOrderOfVerticesAndFaces) {
    const PolygonMesh mesh = parse(triangle + "v 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    EXPECT_TRUE(same_bits(mesh.V, positions_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}})));
    EXPECT_EQ(mesh.faces, polygons_of({{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}));
}

TEST(ReadObj, ReadsEveryFormOfCorner) {
    const PolygonMesh mesh =
        parse(triangle + "vt 0 0\nvn 0 0 1\nf 1/1 2/1 3/1\nf 1//1 2//1 3//1\n" +
              "f 1/1/1 2/1/1 3/1/1\nf -3/-1/-1 -2//-1 -1\n");
    EXPECT_EQ(mesh.faces, polygons_of({{0, 1, 2}, {0, 1, 2}, {0, 1, 2}, {0, 1, 2}}));
}

TEST(ReadObj, CountsNegativeIndicesFromTheVerticesReadSoFar) {
    const PolygonMesh mesh = parse(triangle + "f -3 -2 -1\nv 0 0 1\nf -3 -2 -1\n");
    EXPECT_EQ(mesh.faces, polygons_of({{0, 1, 2}, {1, 2, 3}}));
}

TEST(ReadObj, AcceptsFacesBeforeVertices) {
    EXPECT_EQ(parse("f 1 2 3\n" + triangle).faces, polygons_of({{0, 1, 2}}));
}

TEST(ReadObj, UnderstandsLineEndsTabsCommentsAndJoinedLines) {
    const auto expected = parse(triangle + "f 1 2 3\n");
    for (const std::string& text : {
             std::string(
                 "# c\r\nv\t0 0 0\r\nv 1 0 0 1.0\r\n v 0 1 0 .5 .5 .5\r\n\r\nf 1 2 3 # end\r\n"),
             std::string("v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3"),
             std::string("v 0 \\\n0 0\nv 1 0 0\nv 0 1 0 1 \\\n1 1\nf 1 \\\r\n 2\\\n 3\n"),
             std::string("# path c:\\\nv +0 0 0 # c:\\\nv 1.e0 0 0\nv 0 1E+0 0\no f\ng v 1\ns off\n"
                         "usemtl f 7\nmtllib x.mtl\nl 1 2\np 1\nvp 1 2\nf 1 2 3"),
         }) {
        const PolygonMesh mesh = parse(text);
        EXPECT_TRUE(same_bits(mesh.V, expected.V)) << text;
        EXPECT_EQ(mesh.faces, expected.faces) << text;
    }
}

TEST(ReadObj, PassesOnIsolatedVerticesAndRepeatedCorners) {
    const PolygonMesh mesh = parse(triangle + "v 9 9 9\nf 1 1 2\n");
    EXPECT_EQ(mesh.V.rows(), 4);
    EXPECT_EQ(mesh.faces, polygons_of({{0, 0, 1}}));
}

TEST(ReadObj, ReadsTinyNumbersAsTheNearestDouble) {
    const PolygonMesh mesh = parse("v 1e-400 4.9e-324 0.1\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_EQ(mesh.V(0, 0), 0);
    EXPECT_EQ(mesh.V(0, 1), 4.9e-324);
    EXPECT_EQ(mesh.V(0, 2), 0.1);
}

TEST(ReadObj, RefusesWhatIsNoMeshFile) {
    expect_obj_fault("\x7f\x45LF binary\n", InputFault::mesh, {"file.obj", "no vertices"});
    expect_obj_fault(triangle, InputFault::mesh, {"file.obj", "no faces"});
    expect_obj_fault("v 0 0 0\nv 1 x 0\n", InputFault::file,
                     {"file.obj:2:", "coordinate", "\"x\""});
    expect_obj_fault("v 0 0\nf 1 2 3\n", InputFault::file, {"file.obj:1:", "coordinate"});
    expect_obj_fault("v 0 0 0a\n", InputFault::file, {"file.obj:1:", "\"0a\""});
    expect_obj_fault(triangle + "f 1 2\n", InputFault::file,
                     {"file.obj:4:", "face 0", "2 corners"});
    expect_obj_fault(triangle + "f\n", InputFault::file, {"file.obj:4:", "0 corners"});
    expect_obj_fault(triangle + "f 1 2 3x\n", InputFault::file, {"file.obj:4:", "corner"});
    expect_obj_fault(triangle + "f 1 2 ?\n", InputFault::file, {"file.obj:4:", "vertex index"});
    expect_obj_fault(triangle + "f 1 2 99999999999999999999\n", InputFault::file, {"file.obj:4:"});
}

TEST(ReadObj, RefusesWhatIsNoValidMesh) {
    expect_obj_fault("v 0 0 0\nv nan 0 0\n", InputFault::mesh,
                     {"file.obj:2:", "vertex 1", "not finite"});
    expect_obj_fault("v 0 -inf 0\n", InputFault::mesh, {"file.obj:1:", "vertex 0", "not finite"});
    expect_obj_fault("v 0 1e999 0\n", InputFault::mesh, {"file.obj:1:", "not finite"});
    expect_obj_fault(triangle + "\nf 1 2 4\n", InputFault::mesh,
                     {"file.obj:5:", "vertex 4", "3 vertices"});
    expect_obj_fault(triangle + "f 0 1 2\n", InputFault::mesh, {"file.obj:4:", "vertex 0"});
    expect_obj_fault(triangle + "f -1 -2 -4\n", InputFault::mesh, {"file.obj:4:", "vertex -4"});
    expect_obj_fault(triangle + "f 1 2 4294967297\n", InputFault::mesh,
                     {"file.obj:4:", "4294967297"});
}

TEST(ReadObjPositions, AgreesWithTheWholeReaderOnAFrameOfTheSamePattern) {
    const std::string faces = "vt 0 0\nf 1 2 3\nf -1 -2 -3\n";
    const ObjPattern pattern = find_obj_pattern(triangle + faces, "a.obj");
    EXPECT_EQ(pattern.vertex_count, 3);
    const std::string other = "# frame 2\no body\nv 5 0 1e-3\nv 1 0 0 1\nv 0 1.25 0 # c\n";
    const auto V = parse_obj_positions(other + faces, "b.obj", pattern);
    ASSERT_TRUE(V.has_value());
    EXPECT_TRUE(same_bits(*V, parse(other + faces).V));
}

TEST(ReadObjPositions, LeavesEverythingElseToTheWholeReader) {
    const std::string faces = "f 1 2 3\n";
    const ObjPattern pattern = find_obj_pattern(triangle + faces, "a.obj");
    for (const std::string& text :
         {triangle + "f 1 3 2\n", triangle + "v 0 0 0\n" + faces, "v 0 0 0\nv 0 0 1\n" + faces,
          triangle + faces + "f 3 2 1\n", "f 3 2 1\n" + triangle + faces,
          "v 0 0 0\nv 1 0 0\nv 0 1 " + faces, std::string()}) {
        std::optional<Positions> V;
        try {
            V = parse_obj_positions(text, "b.obj", pattern);
        } catch (const InputError&) {
            EXPECT_THROW(parse(text), InputError);
        }
        EXPECT_FALSE(V.has_value()) << text;
    }
    EXPECT_TRUE(find_obj_pattern("v 0 0 0\nf 1 2 3\nv 1 0 0\nv 0 1 0\n", "a.obj").tail.empty());
}

}  // namespace
}  // namespace kinequad::test
