#include "kinequad/io/read_stl.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "kinequad/io/byte_order.h"
#include "kinequad/io/text_scanner.h"

namespace kinequad {
namespace {

constexpr std::size_t header_size = 84;
constexpr std::size_t triangle_size = 50;

std::uint64_t triangles_in_header(std::string_view bytes) {
    return load_number<std::uint32_t>(bytes.data() + 80, std::endian::little);
}

// Binary files may begin with "solid" too: what tells the two apart is the size.
bool is_binary(std::string_view bytes) {
    return bytes.size() >= header_size &&
           bytes.size() == header_size + triangle_size * triangles_in_header(bytes);
}

std::vector<Vector3> read_binary_corners(std::string_view bytes, const std::string& name) {
    const std::uint64_t count = triangles_in_header(bytes);
    if (count > std::numeric_limits<int>::max() / 3) {
        throw InputError(InputFault::mesh,
                         fmt::format("{}: {} triangles are more than can be read", name, count));
    }
    std::vector<Vector3> corners;
    corners.reserve(3 * count);
    for (std::uint64_t t = 0; t < count; ++t) {
        const char* at = bytes.data() + header_size + triangle_size * t + 12;
        for (int k = 0; k < 3; ++k, at += 12) {
            Vector3 p;
            for (int axis = 0; axis < 3; ++axis) {
                p[axis] = load_number<float>(at + std::ptrdiff_t{4} * axis, std::endian::little);
            }
            if (!p.allFinite()) {
                throw InputError(InputFault::mesh,
                                 fmt::format("{}: triangle {} has a corner that is not finite; "
                                             "give it a position",
                                             name, t));
            }
            corners.push_back(p);
        }
    }
    return corners;
}

Vector3 read_ascii_corner(TextScanner& scanner) {
    const std::size_t start = scanner.position();
    Vector3 p;
    for (int axis = 0; axis < 3; ++axis) {
        scanner.skip_to_token();
        p[axis] = scanner.read_number("a coordinate");
    }
    if (!p.allFinite()) {
        scanner.fail_at(start, InputFault::mesh, "a corner is not finite; give it a position");
    }
    return p;
}

std::vector<Vector3> read_ascii_corners(std::string_view bytes, const std::string& name) {
    TextScanner scanner(bytes, name, '\n');
    scanner.skip_line();
    std::vector<Vector3> corners;
    std::size_t in_facet = 0;
    bool is_closed = false;
    for (scanner.skip_to_token(); !scanner.at_end(); scanner.skip_to_token()) {
        const std::string_view keyword = scanner.read_token();
        if (keyword == "vertex") {
            corners.push_back(read_ascii_corner(scanner));
            ++in_facet;
        } else if (keyword == "endfacet") {
            if (in_facet != 3) {
                scanner.fail(InputFault::file,
                             fmt::format("a facet has {} corners, 3 are needed", in_facet));
            }
            in_facet = 0;
        } else if (keyword == "endsolid" || keyword == "solid") {
            is_closed = keyword == "endsolid";
            scanner.skip_line();
        } else if (keyword == "facet") {
            scanner.skip_line();
        } else if (keyword != "outer" && keyword != "loop" && keyword != "endloop") {
            scanner.fail(InputFault::file, "a line of the STL text cannot be read");
        }
    }
    if (!is_closed || in_facet != 0) {
        scanner.fail(InputFault::file, "the STL text has no endsolid at its end; is it cut off?");
    }
    return corners;
}

/// Corners with the same coordinates become one vertex; -0 is 0.
PolygonMesh weld(std::vector<Vector3> corners) {
    for (Vector3& p : corners) p += Vector3::Zero();
    const auto less = [&](std::size_t a, std::size_t b) {
        for (int axis = 0; axis < 3; ++axis) {
            if (corners[a][axis] != corners[b][axis]) return corners[a][axis] < corners[b][axis];
        }
        return a < b;
    };
    std::vector<std::size_t> order(corners.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), less);
    std::vector<std::size_t> first(corners.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
        const bool same = k > 0 && corners[order[k]] == corners[order[k - 1]];
        first[order[k]] = same ? first[order[k - 1]] : order[k];
    }
    std::vector<int> vertex(corners.size());
    std::vector<Vector3> points;
    PolygonMesh mesh;
    for (std::size_t c = 0; c < corners.size(); ++c) {
        if (first[c] == c) {
            vertex[c] = static_cast<int>(points.size());
            points.push_back(corners[c]);
        }
        vertex[c] = vertex[first[c]];
    }
    for (std::size_t t = 0; t < corners.size() / 3; ++t) {
        mesh.faces.add(std::span<const int>(vertex).subspan(3 * t, 3));
    }
    mesh.V = Eigen::Map<const Positions>(points.data()->data(),
                                         static_cast<Eigen::Index>(points.size()), 3);
    return mesh;
}

}  // namespace

PolygonMesh parse_stl(std::string_view bytes, const std::string& name) {
    std::vector<Vector3> corners;
    if (is_binary(bytes)) {
        corners = read_binary_corners(bytes, name);
    } else if (bytes.starts_with("solid")) {
        corners = read_ascii_corners(bytes, name);
    } else {
        throw InputError(InputFault::file,
                         name +
                             ": is no STL file, or its count of triangles does not fit its size; "
                             "is it cut off?");
    }
    if (corners.empty()) {
        throw InputError(InputFault::mesh, name + ": has no triangles; is it a mesh?");
    }
    return weld(std::move(corners));
}

}  // namespace kinequad
