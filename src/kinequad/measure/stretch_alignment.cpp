#include "kinequad/measure/stretch_alignment.h"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "kinequad/core/error.h"
#include "kinequad/core/parallel.h"
#include "kinequad/measure/triangulation.h"
#include "kinequad/mesh/closest_points.h"

namespace kinequad {
namespace {

constexpr std::size_t block_size = 512;
/// A triangle stretched more than this has collapsed: its directions are rounding.
constexpr double largest_stretch = 1e6;

/// Edge vectors of corners 1 and 2 from corner 0, in a frame with its x-axis along the first.
Eigen::Matrix2d edge_vectors(const Vector3& ab, const Vector3& ac) {
    const double length = ab.norm();
    Eigen::Matrix2d P;
    P << length, length > 0 ? ac.dot(ab) / length : 0.0, 0,
        length > 0 ? ab.cross(ac).norm() / length : 0.0;
    return P;
}

Complex fourth_power(const Eigen::Vector2d& direction) {
    const double length = direction.norm();
    if (!(length > 0)) return 0;
    const Complex z(direction[0] / length, direction[1] / length);
    return (z * z) * (z * z);
}

/// Mean of the fourth powers of the directions of a quad's sides, projected onto the triangle `a`,
/// `ab`, `ac` and read off in the triangle's shape at rest; zero where it says nothing.
Complex cross_over(const Positions& X, const Polygons& faces, int f, const Vector3& ab,
                   const Vector3& ac, const Eigen::Matrix2d& rest) {
    Eigen::Matrix2d gram;
    gram << ab.dot(ab), ab.dot(ac), ab.dot(ac), ac.dot(ac);
    Complex sum = 0;
    for (int k = 0; k < 4; ++k) {
        const Vector3 side =
            (X.row(vertex_of(faces, f, (k + 1) % 4)) - X.row(vertex_of(faces, f, k))).transpose();
        const Eigen::Vector2d along = gram.inverse() * Eigen::Vector2d(side.dot(ab), side.dot(ac));
        sum += fourth_power(rest * along);
    }
    const double modulus = std::abs(sum);
    return std::isfinite(modulus) && modulus > 1e-9 ? sum / modulus : Complex(0);
}

struct Stretch {
    double strength = 0;
    Complex fourth_power = 1;
};

/// Principal stretch of `J`: the larger singular value over the smaller, minus one, and the fourth
/// power of its right singular vector.
Stretch stretch_of(const Eigen::Matrix2d& J) {
    const Eigen::Matrix2d G = J.transpose() * J;
    const double x = G(0, 0) - G(1, 1);
    const double y = 2 * G(0, 1);
    const double r = std::hypot(x, y);
    const double trace = G(0, 0) + G(1, 1);
    if (!(r > 0)) return {};
    // The product of the singular values is |det J|: exact where trace - r cancels.
    const double determinant = std::abs(J.determinant());
    const double strength = 0.5 * (trace + r) / determinant - 1;
    const Complex squared(x / r, y / r);
    return {strength, squared * squared};
}

}  // namespace

const double StretchAlignment::unknown = std::numeric_limits<double>::quiet_NaN();

Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> triangle_sides(
    const Topology& topology, const IntrinsicMetric& metric) {
    Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> result(topology.triangle_count, 3);
    for (int t = 0; t < topology.triangle_count; ++t) {
        const std::array<double, 3> sides = side_lengths(topology, metric, t);
        result.row(t) << sides[0], sides[1], sides[2];
    }
    return result;
}

StretchAlignment::StretchAlignment(const StretchReference& reference, const Context& context)
    : F_(reference.F) {
    const Positions& V = reference.V;
    const Triangles& F = reference.F;
    const auto& sides = reference.sides;
    const Positions& X = reference.X;
    const Polygons& faces = reference.faces;
    check_polygons(faces, static_cast<int>(X.rows()));
    const Triangulation cut = triangulate_for_measuring(faces, X);
    const ClosestPoints surface(X, cut.F);
    const auto m = static_cast<std::size_t>(F.rows());
    inverse_rest_.resize(m);
    area_ = Eigen::VectorXd::Zero(F.rows());
    cross_ = Eigen::VectorXcd::Zero(F.rows());
    parallel_for(m, block_size, context, [&](std::size_t begin, std::size_t end) {
        int hint = -1;
        for (std::size_t i = begin; i < end; ++i) {
            const auto t = static_cast<Eigen::Index>(i);
            const auto corners = lay_out_triangle({sides(t, 0), sides(t, 1), sides(t, 2)});
            Eigen::Matrix2d rest;
            rest << corners.col(1) - corners.col(0), corners.col(2) - corners.col(0);
            inverse_rest_[i] = rest.inverse();
            if (!inverse_rest_[i].allFinite()) continue;
            const Vector3 a = V.row(F(t, 0)).transpose();
            const Vector3 ab = V.row(F(t, 1)).transpose() - a;
            const Vector3 ac = V.row(F(t, 2)).transpose() - a;
            hint = surface.find(a + (ab + ac) / 3, hint).point.triangle;
            const int face = cut.face[static_cast<std::size_t>(hint)];
            if (degree_of(faces, face) != 4) continue;
            cross_[t] = cross_over(X, faces, face, ab, ac, rest);
            if (cross_[t] != Complex(0)) area_[t] = 0.5 * std::abs(rest.determinant());
        }
    });
}

void StretchAlignment::add_frame(const Positions& V, const Context& context) {
    const auto m = static_cast<std::size_t>(F_.rows());
    // Two sums a block, added up in the order of the blocks.
    std::vector<std::array<double, 2>> sums((m + block_size - 1) / block_size, {0, 0});
    parallel_for(m, block_size, context, [&](std::size_t begin, std::size_t end) {
        auto& [weight, weighted] = sums[begin / block_size];
        for (std::size_t i = begin; i < end; ++i) {
            const auto t = static_cast<Eigen::Index>(i);
            if (!(area_[t] > 0)) continue;
            const Vector3 a = V.row(F_(t, 0)).transpose();
            const Vector3 ab = V.row(F_(t, 1)).transpose() - a;
            const Vector3 ac = V.row(F_(t, 2)).transpose() - a;
            const Stretch stretch = stretch_of(edge_vectors(ab, ac) * inverse_rest_[i]);
            if (!(stretch.strength > 0 && stretch.strength < largest_stretch)) continue;
            const double angle =
                std::abs(std::arg(stretch.fourth_power * std::conj(cross_[t]))) / 4;
            weight += area_[t] * stretch.strength;
            weighted += area_[t] * stretch.strength * angle * (180 / std::numbers::pi);
        }
    });
    for (const auto& [weight, weighted] : sums) {
        weight_ += weight;
        weighted_degrees_ += weighted;
    }
}

}  // namespace kinequad
