// Arbitrary bytes as an integer-grid map: a small mesh whose corners and transitions are what the
// bytes say, flipped, torn and out of range as they come.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include "kinequad/core/error.h"
#include "kinequad/extract/extract_quads.h"
#include "kinequad/extract/verify_quad_mesh.h"

namespace {

using namespace kinequad;

/// Numbers read off the front of the input; zeros behind its end.
class Bytes {
public:
    Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
    template <class Number>
    Number take() {
        Number number{};
        const std::size_t count = size_ < sizeof(Number) ? size_ : sizeof(Number);
        std::memcpy(&number, data_, count);
        data_ += count;
        size_ -= count;
        return number;
    }

private:
    const std::uint8_t* data_;
    std::size_t size_;
};

Triangles choose_mesh(int which) {
    Triangles F;
    switch (which % 4) {
        case 0:
            F.resize(1, 3);
            F << 0, 1, 2;
            break;
        case 1:
            F.resize(2, 3);
            F << 0, 1, 2, 0, 2, 3;
            break;
        case 2:
            F.resize(4, 3);
            F << 0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3;
            break;
        default:  // a torus of 3 x 3 cells
            F.resize(18, 3);
            for (int i = 0; i < 3; ++i) {
                for (int j = 0; j < 3; ++j) {
                    const auto at = [](int a, int b) { return 3 * (a % 3) + b % 3; };
                    F.row(6 * i + 2 * j) << at(i, j), at(i, j + 1), at(i + 1, j + 1);
                    F.row(6 * i + 2 * j + 1) << at(i, j), at(i + 1, j + 1), at(i + 1, j);
                }
            }
    }
    return F;
}

/// A coordinate: mostly a small number of half cells, where maps are nearly right, else anything.
std::int64_t coordinate(Bytes& bytes, bool is_wild) {
    if (is_wild) return bytes.take<std::int64_t>();
    return std::int64_t{bytes.take<std::int8_t>()} * (GridMap::one / 2);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes bytes(data, size);
    const auto flags = bytes.take<std::uint8_t>();
    GridMap map;
    map.mesh.F = choose_mesh(flags & 3);
    map.mesh.vertex_count = map.mesh.F.maxCoeff() + 1;
    map.topology = build_topology(map.mesh.F, map.mesh.vertex_count);
    const auto corners = static_cast<std::size_t>(map.mesh.F.size());
    map.mesh.barycentric.resize(map.mesh.F.size(), 3);
    for (int t = 0; t < map.topology.triangle_count; ++t) {
        map.mesh.parent.push_back(t);
        map.mesh.barycentric.middleRows<3>(3 * t).setIdentity();
    }
    map.index = Eigen::VectorXi::Zero(map.mesh.vertex_count);
    map.corner.resize(corners);
    map.transition.resize(corners);
    map.is_line.assign(corners, 0);
    const bool is_wild = (flags & 4) != 0;
    for (GridMap::Coordinate& corner : map.corner) {
        corner.u = coordinate(bytes, is_wild);
        corner.v = coordinate(bytes, is_wild);
    }
    for (std::size_t h = 0; h < corners; ++h) {
        const int other = map.topology.twin[h];
        if (other < 0) continue;
        GridMap::Transition& across = map.transition[h];
        across.rotation =
            (flags & 8) != 0 ? bytes.take<std::int8_t>() : bytes.take<std::uint8_t>() & 3;
        if ((flags & 16) != 0) {
            across.translation = {coordinate(bytes, is_wild), coordinate(bytes, is_wild)};
        } else if (!is_wild) {
            // The translation that makes one end fit.
            const GridMap::Coordinate turned = rotate(map.corner[h], across.rotation);
            const GridMap::Coordinate there =
                map.corner[static_cast<std::size_t>(Topology::next(other))];
            across.translation = {there.u - turned.u, there.v - turned.v};
        }
    }
    try {
        const QuadMesh mesh = extract_quads(map, Context{});
        require_valid(verify_quad_mesh(mesh, map.topology));
    } catch (const Error& error) {
        if (std::string_view(error.what()).find('\n') != std::string_view::npos) std::abort();
    }
    return 0;
}
