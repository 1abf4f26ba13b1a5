#include <gtest/gtest.h>

#include <cstdint>

#include "io_support.h"
#include "kinequad/io/byte_order.h"
#include "kinequad/io/read_off.h"
#include "kinequad/io/read_ply.h"
#include "kinequad/io/read_polygon_mesh.h"
#include "kinequad/io/read_stl.h"

namespace kinequad::test {
namespace {

template <class Number>
std::string bytes_of(Number number, std::endian order) {
    std::string bytes(sizeof(Number), '\0');
    store_number(bytes.data(), number, order);
    return bytes;
}

void expect_ply_fault(const std::string& text, InputFault fault,
                      const std::vector<std::string>& parts) {
    expect_input_error([&] { parse_ply(text, "file.ply"); }, fault, parts);
}

void expect_off_fault(const std::string& text, InputFault fault,
                      const std::vector<std::string>& parts) {
    expect_input_error([&] { parse_off(text, "file.off"); }, fault, parts);
}

void expect_stl_fault(const std::string& text, InputFault fault,
                      const std::vector<std::string>& parts) {
    expect_input_error([&] { parse_stl(text, "file.stl"); }, fault, parts);
}

const Polygons quad_and_triangle = polygons_of({{0, 1, 2, 3}, {1, 4, 2}});
const Positions five_points =
    positions_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0.5, -1.5}});

const std::string ply_elements =
    "comment made by hand\nobj_info none\nelement material 2\nproperty uchar red\nproperty list "
    "uchar short "
    "tags\nelement vertex 5\nproperty uchar flag\nproperty float x\nproperty double y\nproperty "
    "float "
    "z\nelement face 2\nproperty list uchar int vertex_indices\nproperty list uint8 float "
    "texcoord\n"
    "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n";

TEST(ReadPly, ReadsAsciiAmongOtherElementsAndProperties) {
    const std::string text = "ply\nformat ascii 1.0\n" + ply_elements +
                             "7 0\n8 2 -1 -2\n0 0 0 0\n1 1 0 0\n2 1 1 0\n3 0 1 0\n4 2 .5 -1.5\n"
                             "4 0 1 2 3 2 .5 .5\n3 1 4 2 0\n0 1\n";
    const PolygonMesh mesh = parse_ply(text, "file.ply");
    EXPECT_TRUE(same_bits(mesh.V, five_points));
    EXPECT_EQ(mesh.faces, quad_and_triangle);
    std::string with_carriage_returns;
    for (const char c : text)
        with_carriage_returns += c == '\n' ? std::string("\r\n") : std::string(1, c);
    EXPECT_TRUE(same_bits(parse_ply(with_carriage_returns, "file.ply").V, five_points));
}

std::string binary_ply(std::endian order) {
    const auto b = [&](auto number) { return bytes_of(number, order); };
    std::string body = b(std::uint8_t{7}) + b(std::uint8_t{0}) + b(std::uint8_t{8}) +
                       b(std::uint8_t{2}) + b(std::int16_t{-1}) + b(std::int16_t{-2});
    for (Eigen::Index i = 0; i < 5; ++i) {
        body += b(static_cast<std::uint8_t>(i)) + b(static_cast<float>(five_points(i, 0))) +
                b(five_points(i, 1)) + b(static_cast<float>(five_points(i, 2)));
    }
    body += b(std::uint8_t{4}) + b(0) + b(1) + b(2) + b(3) + b(std::uint8_t{1}) + b(0.5F);
    body += b(std::uint8_t{3}) + b(1) + b(4) + b(2) + b(std::uint8_t{0}) + b(0) + b(1);
    const std::string name = order == std::endian::big ? "big" : "little";
    return "ply\nformat binary_" + name + "_endian 1.0\n" + ply_elements + body;
}

TEST(ReadPly, ReadsBothByteOrders) {
    for (const std::endian order : {std::endian::little, std::endian::big}) {
        const PolygonMesh mesh = parse_ply(binary_ply(order), "file.ply");
        EXPECT_TRUE(same_bits(mesh.V, five_points));
        EXPECT_EQ(mesh.faces, quad_and_triangle);
    }
}

TEST(ReadPly, ReadsDataThatLooksLikeALineEnd) {
    // 0x0a0a0a0a as the first float: the header must end at its own line feed.
    const float odd = std::bit_cast<float>(0x0a0a0a0aU);
    std::string bytes =
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float "
        "y\nproperty float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n";
    for (int k = 0; k < 9; ++k) bytes += bytes_of(odd, std::endian::little);
    bytes += bytes_of(std::uint8_t{3}, std::endian::little);
    for (const int v : {0, 1, 2}) bytes += bytes_of(v, std::endian::little);
    EXPECT_EQ(parse_ply(bytes, "file.ply").V(0, 0), static_cast<double>(odd));
}

std::string small_ply(const std::string& counts, const std::string& body) {
    const std::size_t comma = counts.find(',');
    return "ply\nformat ascii 1.0\nelement vertex " + counts.substr(0, comma) +
           "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
           counts.substr(comma + 1) + "\nproperty list uchar int vertex_indices\nend_header\n" +
           body;
}

TEST(ReadPly, RefusesWhatIsWrong) {
    const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
    expect_ply_fault("plx\n", InputFault::file, {"file.ply", "no PLY"});
    expect_ply_fault("ply\nformat ascii 1.0\n", InputFault::file, {"file.ply", "end_header"});
    expect_ply_fault("ply\nformat utf8 1.0\n", InputFault::file, {"file.ply:2:", "format"});
    expect_ply_fault("ply\nend_header\n", InputFault::file, {"file.ply", "format"});
    expect_ply_fault("ply\nformat ascii 1.0\nelement vertex x\n", InputFault::file,
                     {"file.ply:3:"});
    expect_ply_fault("ply\nformat ascii 1.0\nelement vertex -3\n", InputFault::file, {"-3"});
    expect_ply_fault("ply\nformat ascii 1.0\nelement vertex 3\nproperty half x\n", InputFault::file,
                     {"file.ply:4:", "type"});
    expect_ply_fault("ply\nformat ascii 1.0\nhello\n", InputFault::file, {"file.ply:3:"});
    expect_ply_fault(small_ply("2000000000,1", points), InputFault::file,
                     {"file.ply", "2000000000", "\"vertex\"", "cut off"});
    expect_ply_fault(small_ply("3,2", points + "3 0 1 2\n"), InputFault::file, {"file.ply"});
    expect_ply_fault(small_ply("3,1", points + "3 0 1 2\n3 0 1 2\n"), InputFault::file,
                     {"file.ply", "header"});
    expect_ply_fault(small_ply("3,1", points + "200 0 1 2\n"), InputFault::file,
                     {"200", "cut off"});
    expect_ply_fault(small_ply("3,1", points + "2 0 1\n"), InputFault::file,
                     {"face 0", "2 corners"});
    expect_ply_fault(small_ply("3,1", points + "3 0 1 x\n"), InputFault::file,
                     {"file.ply:13:", "\"x\""});
    expect_ply_fault(small_ply("3,1", points + "3 0 1 3\n"), InputFault::mesh,
                     {"face 0", "vertex 3"});
    expect_ply_fault(small_ply("3,1", points + "3 0 1 -1\n"), InputFault::mesh,
                     {"face 0", "vertex -1"});
    expect_ply_fault(small_ply("3,1", "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n"), InputFault::mesh,
                     {"vertex 1", "not finite"});
    expect_ply_fault(small_ply("3,0", points), InputFault::mesh, {"no faces"});
    expect_ply_fault(small_ply("0,0", ""), InputFault::mesh, {"no vertices"});
    expect_ply_fault(
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float "
        "y\nend_header\n0 0\n",
        InputFault::file, {"file.ply", "x, y and z"});
}

TEST(ReadOff, ReadsHeadersColoursAndComments) {
    const std::string body = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 .5 -1.5\n4 0 1 2 3\n3 1 4 2 255 0 0\n";
    for (const std::string& text :
         {"OFF\n5 2 0\n" + body, "OFF 5 2 0\n" + body, "# c\nOFF # d\n\n5 2\n" + body,
          std::string(
              "COFF\r\n5 2 7\r\n0 0 0 255 0 0\r\n1 0 0 1 1 1\r\n1 1 0\r\n0 1 0\r\n2 .5 -1.5 # e\r\n"
              "4 0 1 2 3\r\n3 1 4 2")}) {
        const PolygonMesh mesh = parse_off(text, "file.off");
        EXPECT_TRUE(same_bits(mesh.V, five_points)) << text;
        EXPECT_EQ(mesh.faces, quad_and_triangle) << text;
    }
}

TEST(ReadOff, RefusesWhatIsWrong) {
    const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
    expect_off_fault("4OFF\n", InputFault::file, {"file.off:1:", "OFF"});
    expect_off_fault("OFF BINARY\n", InputFault::file, {"file.off:1:", "binary"});
    expect_off_fault("OFF\n2000000000 1 0\n" + points, InputFault::file,
                     {"file.off:2:", "2000000000", "cut off"});
    expect_off_fault("OFF\n3 -1 0\n" + points, InputFault::file, {"file.off:2:", "-1"});
    expect_off_fault("OFF\n3 1 0\n" + points + "3 0 1 3\n", InputFault::mesh,
                     {"file.off:6:", "face 0", "vertex 3", "0 to 2"});
    expect_off_fault("OFF\n3 1 0\n" + points + "3 0 1\n", InputFault::file, {"file.off:6:"});
    expect_off_fault("OFF\n3 1 0\n" + points + "2 0 1\n", InputFault::file,
                     {"file.off:6:", "2 corners"});
    expect_off_fault("OFF\n3 1 0\n" + points, InputFault::file, {"file.off"});
    expect_off_fault("OFF\n2 1 0\n" + points + "3 0 1 2\n", InputFault::file, {"file.off:5:"});
    expect_off_fault("OFF\n3 1 0\n0 0 0\n1 inf 0\n0 1 0\n3 0 1 2\n", InputFault::mesh,
                     {"file.off:4:", "vertex 1", "not finite"});
    expect_off_fault("OFF\n3 0 0\n" + points, InputFault::mesh, {"no faces"});
    expect_off_fault("OFF\n3 1 0\n" + points + "3 0 1 2\n3 0 1 2\n", InputFault::file,
                     {"file.off:7:", "header"});
}

std::string binary_stl(const std::vector<float>& coordinates) {
    std::string bytes(80, 's');
    bytes += bytes_of(static_cast<std::uint32_t>(coordinates.size() / 9), std::endian::little);
    for (std::size_t t = 0; t < coordinates.size() / 9; ++t) {
        bytes += std::string(12, '\0');
        for (std::size_t k = 0; k < 9; ++k)
            bytes += bytes_of(coordinates[9 * t + k], std::endian::little);
        bytes += std::string(2, '\0');
    }
    return bytes;
}

const std::vector<float> two_facets = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, -0.0F, 0, 1, 1, 0, 0, 1, 0};
const std::string ascii_stl =
    "solid two\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
    "0\nendloop\nendfacet\n"
    "facet normal 0 0 1\nouter loop\nvertex 1 -0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\n"
    "endsolid two\n";

TEST(ReadStl, JoinsCornersAtTheSamePlace) {
    for (const std::string& bytes : {binary_stl(two_facets), ascii_stl}) {
        const PolygonMesh mesh = parse_stl(bytes, "file.stl");
        EXPECT_TRUE(same_bits(mesh.V, positions_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}})));
        EXPECT_EQ(mesh.faces, polygons_of({{0, 1, 2}, {1, 3, 2}}));
    }
    std::string named_solid = binary_stl(two_facets);
    named_solid.replace(0, 6, "solid ");
    EXPECT_EQ(parse_stl(named_solid, "file.stl").faces.count(), 2);
}

TEST(ReadStl, RefusesWhatIsWrong) {
    expect_stl_fault(binary_stl(two_facets) + "x", InputFault::file, {"file.stl", "count"});
    expect_stl_fault(binary_stl({}), InputFault::mesh, {"file.stl", "no triangles"});
    std::vector<float> bad = two_facets;
    bad[10] = std::numeric_limits<float>::quiet_NaN();
    expect_stl_fault(binary_stl(bad), InputFault::mesh, {"file.stl", "triangle 1", "not finite"});
    expect_stl_fault(ascii_stl.substr(0, 120), InputFault::file, {"file.stl", "cut off"});
    expect_stl_fault("solid\nvertex 0 0 x\n", InputFault::file, {"file.stl:2:", "\"x\""});
    expect_stl_fault("solid\nvertex 0 0 nan\n", InputFault::mesh, {"file.stl:2:", "not finite"});
    expect_stl_fault("solid\nvertex 0 0 0\nendfacet\n", InputFault::file,
                     {"file.stl:3:", "1 corners"});
    expect_stl_fault("solid\nendsolid\n", InputFault::mesh, {"no triangles"});
}

TEST(ReadPolygonMesh, ChoosesTheFormatByExtensionInAnyCase) {
    const ScratchFolder folder;
    EXPECT_EQ(read_polygon_mesh(folder.put("a.OBJ", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"))
                  .faces.count(),
              1);
    EXPECT_EQ(read_polygon_mesh(folder.put("a.Stl", ascii_stl)).faces.count(), 2);
    expect_input_error([&] { read_polygon_mesh(folder.put("a.txt", "x")); }, InputFault::file,
                       {"a.txt", "OBJ, PLY, OFF or STL"});
    expect_input_error([&] { read_polygon_mesh(folder.put("a.off", "")); }, InputFault::file,
                       {"a.off", "empty"});
    expect_input_error([&] { read_polygon_mesh(folder / "none.obj"); }, InputFault::file,
                       {"none.obj", "cannot be opened"});
    std::filesystem::create_directory(folder / "folder.obj");
    expect_input_error([&] { read_polygon_mesh(folder / "folder.obj"); }, InputFault::file,
                       {"folder.obj", "not a regular file"});
}

}  // namespace
}  // namespace kinequad::test
