#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "kinequad/io/landmarks.h"
#include "kinequad/mesh/intrinsic_metric.h"
#include "kinequad/mesh/triangle_mesh.h"
#include "support/shapes.h"

namespace kinequad::test {

/// A shape that mirrors in x = 0, with its true map.
struct SymmetricShape {
    TriangleMesh mesh;
    std::vector<int> mirror;  ///< mirror vertex of every vertex
    Landmarks landmarks;
};

inline std::vector<int> mirror_in_x(const Positions& V) {
    const auto key = [&](Eigen::Index v, double sign) {
        return std::array{std::lround(sign * 1e9 * V(v, 0)), std::lround(1e9 * V(v, 1)),
                          std::lround(1e9 * V(v, 2))};
    };
    std::map<std::array<long, 3>, int> at;
    for (Eigen::Index v = 0; v < V.rows(); ++v) at[key(v, 1)] = static_cast<int>(v);
    std::vector<int> mirror;
    for (Eigen::Index v = 0; v < V.rows(); ++v) mirror.push_back(at.at(key(v, -1)));
    return mirror;
}

/// Nearest vertex to a direction from the origin.
inline int vertex_towards(const Positions& V, const Vector3& direction) {
    Eigen::Index best = 0;
    (V.rowwise().normalized() * direction.normalized()).maxCoeff(&best);
    return static_cast<int>(best);
}

/// An ellipsoid with bumps that have no symmetry but the mirror in x = 0.
inline SymmetricShape bumpy_ellipsoid(int levels) {
    SymmetricShape shape;
    shape.mesh = sphere(levels);
    Positions& V = shape.mesh.V;
    shape.mirror = mirror_in_x(V);
    for (Eigen::Index v = 0; v < V.rows(); ++v) {
        const Vector3 p = V.row(v).transpose();
        const double bump =
            0.35 *
                std::exp(
                    -8 *
                    (Vector3(std::abs(p[0]), p[1], p[2]) - Vector3(0.7, 0.5, 0.5)).squaredNorm()) +
            0.2 * p[1] * p[2] + 0.15 * p[1] * p[1] * p[1];
        V.row(v) = (1 + bump) * Vector3(p[0], 1.4 * p[1], 0.8 * p[2]).transpose();
    }
    const auto add_pair = [&](const Vector3& direction) {
        const int v = vertex_towards(V, direction);
        shape.landmarks.pairs.push_back({v, shape.mirror[static_cast<std::size_t>(v)]});
    };
    add_pair({0.7, 0.7, 0.4});
    add_pair({1, -0.2, -0.1});
    add_pair({0.6, -1, 0.5});
    add_pair({0.5, 0.6, -0.8});
    shape.landmarks.stationary = {vertex_towards(V, {0, 1, 0}), vertex_towards(V, {0, 0, -1})};
    return shape;
}

inline IntrinsicMetric metric_of(const TriangleMesh& mesh) {
    return kinequad::metric_of(build_topology(mesh.F, static_cast<int>(mesh.V.rows())), mesh.V);
}

/// The same mesh with vertex v as number `number[v]` and its triangles in reverse order, each begun
/// at its second corner.
inline TriangleMesh renumbered(const TriangleMesh& mesh, const std::vector<int>& number) {
    TriangleMesh result = mesh;
    for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
        result.V.row(number[static_cast<std::size_t>(v)]) = mesh.V.row(v);
    }
    for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
        for (int k = 0; k < 3; ++k) {
            result.F(mesh.F.rows() - 1 - t, k) =
                number[static_cast<std::size_t>(mesh.F(t, (k + 1) % 3))];
        }
    }
    return result;
}

/// Distances of the images from the true ones, in percent of the diagonal; 0 where there is none.
inline Eigen::VectorXd map_errors(const TriangleMesh& mesh, const std::vector<SurfacePoint>& image,
                                  const std::vector<int>& mirror) {
    Eigen::VectorXd error(mesh.V.rows());
    for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
        const auto i = static_cast<std::size_t>(v);
        error[v] = 0;
        if (image[i].triangle < 0) continue;
        error[v] =
            (position_of(image[i], mesh.V, mesh.F) - mesh.V.row(mirror[i]).transpose()).norm();
    }
    return 100 / bounding_box_diagonal(mesh.V) * error;
}

/// Largest error of the transport against mirroring directions in x = 0, in radians, over the
/// triangles whose centre falls into the mirrored triangle.
inline double transport_error(const TriangleMesh& mesh,
                              const std::vector<SurfacePoint>& centre_image,
                              const Eigen::VectorXd& transport, const std::vector<int>& mirror) {
    double worst = 0;
    for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
        const int s = centre_image[static_cast<std::size_t>(t)].triangle;
        std::array<int, 3> expected{};
        std::array<int, 3> found{};
        for (int k = 0; k < 3; ++k) {
            expected[static_cast<std::size_t>(k)] = mirror[static_cast<std::size_t>(mesh.F(t, k))];
            found[static_cast<std::size_t>(k)] = mesh.F(s, k);
        }
        std::sort(expected.begin(), expected.end());
        std::sort(found.begin(), found.end());
        if (expected != found) continue;
        const auto edge = [&](Eigen::Index f, int k) -> Vector3 {
            return (mesh.V.row(mesh.F(f, k)) - mesh.V.row(mesh.F(f, 0))).transpose();
        };
        Vector3 direction = edge(t, 1);
        direction[0] *= -1;
        const Vector3 x = edge(s, 1).normalized();
        const Vector3 y = edge(s, 1).cross(edge(s, 2)).cross(x).normalized();
        const double angle = std::atan2(direction.dot(y), direction.dot(x));
        worst =
            std::max(worst, std::abs(std::remainder(angle - transport[t], 2 * std::numbers::pi)));
    }
    return worst;
}

}  // namespace kinequad::test
