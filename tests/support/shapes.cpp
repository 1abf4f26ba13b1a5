#include "support/shapes.h"

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace kinequad::test {
namespace {

using Corners = std::array<int, 3>;

TriangleMesh make(const std::vector<Vector3>& points, const std::vector<Corners>& triangles) {
    TriangleMesh mesh;
    mesh.V.resize(static_cast<Eigen::Index>(points.size()), 3);
    mesh.F.resize(static_cast<Eigen::Index>(triangles.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i) {
        mesh.V.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
    }
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            mesh.F(static_cast<Eigen::Index>(t), k) = triangles[t][static_cast<std::size_t>(k)];
        }
    }
    return mesh;
}

/// A rectangular grid of `rows` x `columns` squares over a vertex numbering given by `id(i, j)`.
template <class Id>
std::vector<Corners> grid_triangles(int rows, int columns, Id id) {
    std::vector<Corners> triangles;
    for (int i = 0; i < rows; ++i) {
        for (int j = 0; j < columns; ++j) {
            const int a = id(i, j);
            const int b = id(i, j + 1);
            const int c = id(i + 1, j + 1);
            const int d = id(i + 1, j);
            triangles.push_back({a, b, c});
            triangles.push_back({a, c, d});
        }
    }
    return triangles;
}

}  // namespace

TriangleMesh tetrahedron() {
    return make({{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}},
                {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}});
}

TriangleMesh cube(int n) {
    std::vector<Vector3> points;
    std::map<std::array<int, 3>, int> ids;
    const auto id_of = [&](const Eigen::Vector3i& p) {
        const auto [where, is_new] =
            ids.try_emplace({p[0], p[1], p[2]}, static_cast<int>(points.size()));
        if (is_new) points.emplace_back(2.0 * p.cast<double>() / n - Vector3::Ones());
        return where->second;
    };
    std::vector<Corners> triangles;
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool high : {false, true}) {
            const auto id = [&](int i, int j) {
                Eigen::Vector3i p;
                p[axis] = high ? n : 0;
                p[(axis + 1) % 3] = high ? j : i;
                p[(axis + 2) % 3] = high ? i : j;
                return id_of(p);
            };
            for (const Corners& t : grid_triangles(n, n, id)) triangles.push_back(t);
        }
    }
    return make(points, triangles);
}

TriangleMesh sphere(int levels) {
    std::vector<Vector3> points = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                   {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
    std::vector<Corners> triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                      {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<int, int>, int> middle;
        const auto middle_of = [&](int a, int b) {
            const auto [where, is_new] =
                middle.try_emplace(std::minmax(a, b), static_cast<int>(points.size()));
            if (is_new) {
                points.push_back(
                    (points[static_cast<std::size_t>(a)] + points[static_cast<std::size_t>(b)])
                        .normalized());
            }
            return where->second;
        };
        std::vector<Corners> finer;
        for (const auto& [a, b, c] : triangles) {
            const int ab = middle_of(a, b);
            const int bc = middle_of(b, c);
            const int ca = middle_of(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        triangles = std::move(finer);
    }
    return make(points, triangles);
}

TriangleMesh torus(int around, int along, double big_radius, double small_radius) {
    std::vector<Vector3> points;
    for (int i = 0; i < along; ++i) {
        for (int j = 0; j < around; ++j) {
            const double s = 2 * std::numbers::pi * j / around;
            const double t = 2 * std::numbers::pi * i / along;
            const double r = big_radius + small_radius * std::cos(t);
            points.emplace_back(r * std::cos(s), r * std::sin(s), small_radius * std::sin(t));
        }
    }
    const auto id = [&](int i, int j) { return (i % along) * around + j % around; };
    return make(points, grid_triangles(along, around, id));
}

TriangleMesh square(int n) {
    std::vector<Vector3> points;
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= n; ++j) points.emplace_back(double(j) / n, double(i) / n, 0);
    }
    return make(points, grid_triangles(n, n, [&](int i, int j) { return i * (n + 1) + j; }));
}

TriangleMesh cylinder(int around, int along, double radius, double height) {
    std::vector<Vector3> points;
    for (int i = 0; i <= along; ++i) {
        for (int j = 0; j < around; ++j) {
            const double s = 2 * std::numbers::pi * j / around;
            points.emplace_back(radius * std::cos(s), radius * std::sin(s), height * i / along);
        }
    }
    const auto id = [&](int i, int j) { return i * around + j % around; };
    return make(points, grid_triangles(along, around, id));
}

}  // namespace kinequad::test
