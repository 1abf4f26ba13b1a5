#pragma once

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <vector>

#include "kinequad/core/index.h"
#include "kinequad/gridmap/grid_map.h"
#include "kinequad/mesh/triangle_mesh.h"

/// Integer-grid maps from meshes and per-corner coordinates, for tests of whatever reads a map. A
/// test that includes this links kinequad_gridmap.
namespace kinequad::test {

/// (u, v) in cells, one a row: corner k of triangle t at row 3t + k.
using CornerCoordinates = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

namespace grid_maps {

/// Fixed-point value of a coordinate; whole where it is so but for rounding errors.
inline std::int64_t fixed_point(double x) {
    const double whole = std::round(x);
    if (std::abs(x - whole) < 1e-7) return static_cast<std::int64_t>(whole) * GridMap::one;
    return std::llround(x * static_cast<double>(GridMap::one));
}

/// The transition that fits an edge whose ends are `a`, `b` on one side and `c`, `d` on the other.
inline GridMap::Transition fit_transition(Complex a, Complex b, Complex c, Complex d) {
    const double turn = std::arg((d - c) / (b - a)) / (std::numbers::pi / 2);
    const int rotation = static_cast<int>(std::lround(turn)) & 3;
    const Complex t = c - a * std::polar(1.0, rotation * std::numbers::pi / 2);
    return {rotation,
            {std::llround(t.real()) * GridMap::one, std::llround(t.imag()) * GridMap::one}};
}

/// Sets the corner of half-edge `h` to `z` and all others around its vertex so that the transitions
/// hold, counter-clockwise; `h` is the vertex's own half-edge.
inline void spread(GridMap& map, int h, GridMap::Coordinate z) {
    const int start = h;
    while (true) {
        map.corner[at(h)] = z;
        const int side = Topology::previous(h);
        h = map.topology.twin[at(side)];
        if (h < 0 || h == start) return;
        z = map.transition[at(side)](z);
    }
}

inline double cone_angle(const GridMap& map, int vertex) {
    double angle = 0;
    for (const int h : outgoing_half_edges(map.topology, vertex)) {
        const auto from = map.corner[at(h)];
        const auto vector_to = [&](int other) {
            const auto to = map.corner[at(other)];
            return Complex(static_cast<double>(to.u - from.u), static_cast<double>(to.v - from.v));
        };
        angle += std::arg(vector_to(Topology::previous(h)) / vector_to(Topology::next(h)));
    }
    return angle;
}

}  // namespace grid_maps

/// The map of `F` (m x 3) with coordinates `uv` (3m x 2) and the transitions that follow from them:
/// the nearest quarter turn and whole translation a edge. Coordinates are made exact vertex by
/// vertex. The map is on the mesh itself, unrefined. It is as valid as `uv` is: ask
/// `verify_grid_map`.
inline GridMap make_grid_map(const Triangles& F, int vertex_count, const CornerCoordinates& uv) {
    using namespace grid_maps;
    GridMap map;
    map.mesh.F = F;
    map.mesh.vertex_count = vertex_count;
    map.mesh.barycentric.resize(F.size(), 3);
    for (int t = 0; t < F.rows(); ++t) {
        map.mesh.parent.push_back(t);
        map.mesh.barycentric.middleRows<3>(3 * t).setIdentity();
    }
    map.topology = build_topology(F, vertex_count);
    map.corner.resize(at(int(F.size())));
    map.transition.resize(at(int(F.size())));
    const auto z = [&](int h) { return Complex(uv(h, 0), uv(h, 1)); };
    for (int h = 0; h < F.size(); ++h) {
        const int other = map.topology.twin[at(h)];
        if (other < 0) continue;
        map.transition[at(h)] =
            fit_transition(z(h), z(Topology::next(h)), z(Topology::next(other)), z(other));
    }
    map.index = Eigen::VectorXi::Zero(vertex_count);
    for (int v = 0; v < vertex_count; ++v) {
        const int h = map.topology.vertex_half_edge[at(v)];
        if (h >= 0) spread(map, h, {fixed_point(uv(h, 0)), fixed_point(uv(h, 1))});
    }
    for (int v = 0; v < vertex_count; ++v) {
        if (map.topology.vertex_half_edge[at(v)] < 0) continue;
        const int quarters =
            static_cast<int>(std::lround(cone_angle(map, v) / (std::numbers::pi / 2)));
        map.index[v] = (map.topology.is_boundary_vertex(v) ? 2 : 4) - quarters;
    }
    return map;
}

/// Coordinates for shapes made of equal patches of `rows` x `columns` squares, each cut into (a, b,
/// c) and (a, c, d) from its lower left corner: every patch gets `across` x `up` cells of its own.
/// Fits torus, cylinder, square (one patch) and cube (six) of tests/support/shapes.h.
inline CornerCoordinates patch_coordinates(int patches, int rows, int columns, int across, int up) {
    CornerCoordinates uv(6 * patches * rows * columns, 2);
    int row = 0;
    for (int square = 0; square < patches * rows * columns; ++square) {
        const int i = square / columns % rows;
        const int j = square % columns;
        for (const auto& [dj, di] : {std::array{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}}) {
            uv.row(row++) << double((j + dj) * across) / columns, double((i + di) * up) / rows;
        }
    }
    return uv;
}

/// A shape with its map.
struct MappedShape {
    TriangleMesh mesh;
    GridMap map;
};

/// A patch shape (see `patch_coordinates`) with its map.
inline MappedShape map_patches(const TriangleMesh& mesh, int patches, int rows, int columns,
                               int across, int up) {
    return {mesh, make_grid_map(mesh.F, static_cast<int>(mesh.V.rows()),
                                patch_coordinates(patches, rows, columns, across, up))};
}

/// Surface of a union of unit cubes at the given lattice points, every face divided into `n` x `n`
/// squares and mapped to `k` x `k` cells. Its vertices have 3 to 6 quarter turns; the genus is the
/// solid's. No two cubes may touch in an edge or a vertex alone.
inline MappedShape map_polycube(const std::vector<std::array<int, 3>>& cubes, int n, int k) {
    std::map<std::array<int, 3>, int> ids;
    std::vector<Vector3> points;
    std::vector<std::array<int, 3>> triangles;
    const auto holds = [&](const std::array<int, 3>& where) {
        for (const auto& cube : cubes) {
            if (cube == where) return true;
        }
        return false;
    };
    int patches = 0;
    for (const auto& cube : cubes) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (const int side : {0, 1}) {
                std::array<int, 3> beside = cube;
                beside[axis] += side == 1 ? 1 : -1;
                if (holds(beside)) continue;
                ++patches;
                const auto id = [&](int i, int j) {
                    std::array<int, 3> p = {n * cube[0], n * cube[1], n * cube[2]};
                    p[axis] += n * side;
                    p[(axis + 1) % 3] += side == 1 ? j : i;
                    p[(axis + 2) % 3] += side == 1 ? i : j;
                    const auto [where, is_new] =
                        ids.try_emplace(p, static_cast<int>(points.size()));
                    if (is_new)
                        points.emplace_back(double(p[0]) / n, double(p[1]) / n, double(p[2]) / n);
                    return where->second;
                };
                for (int i = 0; i < n; ++i) {
                    for (int j = 0; j < n; ++j) {
                        triangles.push_back({id(i, j), id(i, j + 1), id(i + 1, j + 1)});
                        triangles.push_back({id(i, j), id(i + 1, j + 1), id(i + 1, j)});
                    }
                }
            }
        }
    }
    TriangleMesh mesh;
    mesh.V.resize(static_cast<Eigen::Index>(points.size()), 3);
    mesh.F.resize(static_cast<Eigen::Index>(triangles.size()), 3);
    for (Eigen::Index i = 0; i < mesh.V.rows(); ++i) {
        mesh.V.row(i) = points[static_cast<std::size_t>(i)].transpose();
    }
    for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
        const auto& corners = triangles[static_cast<std::size_t>(t)];
        mesh.F.row(t) << corners[0], corners[1], corners[2];
    }
    return map_patches(mesh, patches, n, n, k, k);
}

/// The same map in other charts: triangle t's chart is changed by `gauge[t]`, a quarter turn and a
/// whole translation.
inline GridMap change_charts(const GridMap& map, const std::vector<GridMap::Transition>& gauge) {
    using namespace grid_maps;
    GridMap result = map;
    for (std::size_t h = 0; h < map.corner.size(); ++h) {
        result.corner[h] = gauge[h / 3](map.corner[h]);
        const int other = map.topology.twin[h];
        if (other < 0) continue;
        const GridMap::Transition& here = gauge[h / 3];
        const GridMap::Transition& there = gauge[at(other / 3)];
        // there o transition o here^-1
        const int rotation = (there.rotation + map.transition[h].rotation - here.rotation) & 3;
        const GridMap::Coordinate image = there(map.transition[h]({0, 0}));
        const GridMap::Coordinate back = rotate(here.translation, rotation);
        result.transition[h] = {rotation, {image.u - back.u, image.v - back.v}};
    }
    return result;
}

/// Random charts for `change_charts`, translations up to `cells` cells.
inline std::vector<GridMap::Transition> random_charts(int triangles, int cells,
                                                      std::mt19937& random) {
    std::uniform_int_distribution<int> turn(0, 3);
    std::uniform_int_distribution<std::int64_t> shift(-cells, cells);
    std::vector<GridMap::Transition> gauge;
    for (int t = 0; t < triangles; ++t) {
        const int rotation = turn(random);
        const std::int64_t u = shift(random) * GridMap::one;
        const std::int64_t v = shift(random) * GridMap::one;
        gauge.push_back({rotation, {u, v}});
    }
    return gauge;
}

/// Whether all triangles around a vertex have positive area in the map.
inline bool has_positive_star(const GridMap& map, int vertex) {
    for (const int h : outgoing_half_edges(map.topology, vertex)) {
        const auto from = map.corner[at(h)];
        const auto b = map.corner[at(Topology::next(h))];
        const auto c = map.corner[at(Topology::previous(h))];
        const __int128 area = static_cast<__int128>(b.u - from.u) * (c.v - from.v) -
                              static_cast<__int128>(b.v - from.v) * (c.u - from.u);
        if (area <= 0) return false;
    }
    return true;
}

/// Moves every vertex that is free to move (inside: regular; on the boundary: regular, and along
/// it) by up to `reach` cells at random where its triangles stay positive. With `lattice` > 0 the
/// vertices go to multiples of 1/lattice of a cell, so that integer lines run through many of them
/// and along edges. A valid map stays valid.
inline GridMap jitter_vertices(GridMap map, double reach, int lattice, std::mt19937& random) {
    using namespace grid_maps;
    std::uniform_real_distribution<double> amount(-reach, reach);
    for (int v = 0; v < map.topology.vertex_count; ++v) {
        const int h = map.topology.vertex_half_edge[at(v)];
        if (h < 0 || map.index[v] != 0) continue;
        const GridMap::Coordinate before = map.corner[at(h)];
        const GridMap::Coordinate end = map.corner[at(Topology::next(h))];
        const auto moved = [&](std::int64_t x) {
            const double cells =
                static_cast<double>(x) / static_cast<double>(GridMap::one) + amount(random);
            if (lattice > 0) return std::llround(cells * lattice) * (GridMap::one / lattice);
            return std::llround(cells * static_cast<double>(GridMap::one));
        };
        GridMap::Coordinate after = {moved(before.u), moved(before.v)};
        if (map.topology.is_boundary_vertex(v)) {
            (end.u == before.u ? after.u : after.v) = end.u == before.u ? before.u : before.v;
        }
        spread(map, h, after);
        if (!has_positive_star(map, v)) spread(map, h, before);
    }
    return map;
}

}  // namespace kinequad::test
