#include "kinequad/io/read_off.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <vector>

#include "kinequad/io/text_scanner.h"

namespace kinequad {
namespace {

// "0 0 0" and a line end; "3 0 0 0" and a line end. The last line may lack its end.
constexpr std::int64_t shortest_vertex = 6;
constexpr std::int64_t shortest_face = 8;

void read_header(TextScanner& scanner) {
    scanner.skip_to_token();
    const std::string_view keyword = scanner.read_token();
    const bool known = keyword == "OFF" || keyword == "COFF" || keyword == "NOFF" ||
                       keyword == "CNOFF" || keyword == "STOFF";
    if (!known) {
        scanner.fail(InputFault::file,
                     "is no OFF file of points in space: it has to begin with OFF");
    }
    scanner.skip_to_token();
    if (scanner.rest().starts_with("BINARY")) {
        scanner.fail(InputFault::file, "is a binary OFF file; save it as text");
    }
}

int read_count(TextScanner& scanner, const char* what, std::int64_t shortest) {
    scanner.skip_to_token();
    const std::size_t start = scanner.position();
    const std::int64_t count = scanner.read_integer(what);
    const auto remaining = static_cast<std::int64_t>(scanner.rest().size());
    if (count < 0 || count > std::numeric_limits<int>::max() ||
        count > (remaining + 1) / shortest) {
        scanner.fail_at(
            start, InputFault::file,
            fmt::format("{} {} does not fit a file of this size; is it cut off?", what, count));
    }
    return static_cast<int>(count);
}

Vector3 read_vertex(TextScanner& scanner, int index) {
    scanner.skip_to_token();
    const std::size_t start = scanner.position();
    Vector3 p;
    for (int k = 0; k < 3; ++k) {
        scanner.skip_blanks();
        p[k] = scanner.read_number("a coordinate");
    }
    if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) {
        scanner.fail_at(start, InputFault::mesh,
                        fmt::format("vertex {} is not finite; give it a position", index));
    }
    scanner.skip_line();
    return p;
}

void read_face(TextScanner& scanner, int vertex_count, int index, std::vector<int>& face) {
    scanner.skip_to_token();
    const std::size_t start = scanner.position();
    const std::int64_t corners = scanner.read_integer("a number of corners");
    if (corners < 3) {
        scanner.fail_at(
            start, InputFault::file,
            fmt::format("face {} has {} corners, at least 3 are needed", index, corners));
    }
    face.clear();
    for (std::int64_t k = 0; k < corners; ++k) {
        scanner.skip_blanks();
        const std::int64_t vertex = scanner.read_integer("a vertex index");
        if (vertex < 0 || vertex >= vertex_count) {
            scanner.fail_at(start, InputFault::mesh,
                            fmt::format("face {} names vertex {}, but indices run from 0 to {}",
                                        index, vertex, vertex_count - 1));
        }
        face.push_back(static_cast<int>(vertex));
    }
    scanner.skip_line();
}

}  // namespace

PolygonMesh parse_off(std::string_view text, const std::string& name) {
    TextScanner scanner(text, name);
    read_header(scanner);
    const int vertex_count = read_count(scanner, "a number of vertices", shortest_vertex);
    const int face_count = read_count(scanner, "a number of faces", shortest_face);
    // The number of edges is there, is wrong as often as not, and is not needed.
    scanner.skip_line();
    if (vertex_count == 0) scanner.fail(InputFault::mesh, "has no vertices; is it a mesh?");
    if (face_count == 0) {
        scanner.fail(InputFault::mesh, "has no faces; a mesh with triangles is needed");
    }
    PolygonMesh mesh;
    mesh.V.resize(vertex_count, 3);
    for (int i = 0; i < vertex_count; ++i) mesh.V.row(i) = read_vertex(scanner, i).transpose();
    std::vector<int> face;
    for (int f = 0; f < face_count; ++f) {
        read_face(scanner, vertex_count, f, face);
        mesh.faces.add(face);
    }
    scanner.skip_to_token();
    if (!scanner.at_end()) {
        scanner.fail(InputFault::file,
                     "goes on behind the last face; the counts of its header are wrong");
    }
    return mesh;
}

}  // namespace kinequad
