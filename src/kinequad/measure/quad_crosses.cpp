#include "kinequad/measure/quad_crosses.h"

#include <Eigen/Dense>
#include <array>
#include <cmath>

#include "kinequad/core/index.h"
#include "kinequad/measure/triangulation.h"

namespace kinequad {
namespace {

Triangulation checked_triangulation(const StretchReference& reference) {
    check_polygons(reference.faces, static_cast<int>(reference.X.rows()));
    return triangulate_for_measuring(reference.faces, reference.X);
}

Complex fourth_power(const Eigen::Vector2d& direction) {
    const double length = direction.norm();
    if (!(length > 0)) return 0;
    const Complex z(direction[0] / length, direction[1] / length);
    return (z * z) * (z * z);
}

/// Mean of the fourth powers of the directions of a quad's sides, projected onto the triangle with
/// edge vectors `ab` and `ac` and read off in the triangle's shape at rest; zero where it says
/// nothing.
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

}  // namespace

Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> triangle_sides(
    const Topology& topology, const IntrinsicMetric& metric) {
    Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> result(topology.triangle_count, 3);
    for (int t = 0; t < topology.triangle_count; ++t) {
        const std::array<double, 3> sides = side_lengths(topology, metric, t);
        result.row(t) << sides[0], sides[1], sides[2];
    }
    return result;
}

QuadCrosses::QuadCrosses(const StretchReference& reference)
    : QuadCrosses(reference, checked_triangulation(reference)) {}

QuadCrosses::QuadCrosses(const StretchReference& reference, const Triangulation& cut)
    : reference_(reference), face_(cut.face), surface_(reference.X, cut.F) {}

Eigen::Matrix2d QuadCrosses::rest_shape(int t) const {
    const auto sides = reference_.sides.row(t);
    const auto corners = lay_out_triangle({sides[0], sides[1], sides[2]});
    Eigen::Matrix2d rest;
    rest << corners.col(1) - corners.col(0), corners.col(2) - corners.col(0);
    return rest;
}

QuadCrosses::Cross QuadCrosses::find(const SurfacePoint& point, int hint) const {
    const Positions& V = reference_.V;
    const auto triangle = reference_.F.row(point.triangle);
    const Vector3 a = V.row(triangle[0]).transpose();
    const Vector3 ab = V.row(triangle[1]).transpose() - a;
    const Vector3 ac = V.row(triangle[2]).transpose() - a;
    const Vector3 place = a + point.barycentric[1] * ab + point.barycentric[2] * ac;
    const int nearest = surface_.find(place, hint).point.triangle;
    const int face = face_[at(nearest)];
    if (degree_of(reference_.faces, face) != 4) return {0, nearest};
    return {cross_over(reference_.X, reference_.faces, face, ab, ac, rest_shape(point.triangle)),
            nearest};
}

}  // namespace kinequad
