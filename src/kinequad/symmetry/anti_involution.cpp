#include "kinequad/symmetry/anti_involution.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "kinequad/symmetry/map_to_sphere.h"

namespace kinequad {
namespace {

using Vector4 = Eigen::Vector4d;
using Matrix4 = Eigen::Matrix4d;

RealVector3 row_of(const SpherePoints& points, int i) { return points.row(i).transpose(); }

/// Normal equations, and those of the same rows at unit length.
struct NormalEquations {
    Matrix4 sum = Matrix4::Zero();
    Matrix4 directions = Matrix4::Zero();

    void add(const Vector4& row) {
        sum += row * row.transpose();
        directions += row.normalized() * row.normalized().transpose();
    }
};

/// Equations in (s, n0) that a reflection meets which swaps p and q; they have the same size
/// wherever the points lie, and whatever Moebius transformation moved them.
void add_pair(NormalEquations& normal, const RealVector3& p, const RealVector3& q) {
    const RealVector3 cross = p.cross(q);
    const double sine = static_cast<double>(cross.norm());
    // Two points in one place or opposite of each other say nothing.
    if (sine < 1e-14) return;
    const Vector3 axis = cross.cast<double>() / sine;
    normal.add(Vector4(axis[0], axis[1], axis[2], 0));
    const Vector3 sum = (p + q).cast<double>() / sine;
    const double cosine = static_cast<double>(p.dot(q));
    normal.add(Vector4(sum[0], sum[1], sum[2], -(1 + cosine) / sine));
}

}  // namespace

RealVector3 AntiInvolution::apply(const RealVector3& p) const {
    const RealVector3 direction = s.cast<Real>();
    const Real height = p.dot(direction) - Real(n0);
    return (p - 2 * height * direction) / (1 - 2 * height * Real(n0));
}

AntiInvolution fit_anti_involution(const SpherePoints& points, const SphereLandmarks& landmarks) {
    NormalEquations normal;
    for (const auto& [a, b] : landmarks.pairs)
        add_pair(normal, row_of(points, a), row_of(points, b));
    for (const int v : landmarks.stationary) {
        const Vector3 p = row_of(points, v).cast<double>();
        normal.add(Vector4(p[0], p[1], p[2], -1));
    }
    const Eigen::SelfAdjointEigenSolver<Matrix4> solver(normal.sum);
    const Eigen::SelfAdjointEigenSolver<Matrix4> directions(normal.directions,
                                                            Eigen::EigenvaluesOnly);
    AntiInvolution result;
    const Vector4 n = solver.eigenvectors().col(0);
    const double square = n.head<3>().squaredNorm() - n[3] * n[3];
    result.definiteness = directions.eigenvalues()[1] / directions.eigenvalues()[3];
    result.is_reflection = square > 1e-6;
    if (!result.is_reflection) return result;
    // The sign of an eigenvector is an accident; the largest entry is made positive.
    int largest = 0;
    for (int i = 1; i < 3; ++i) {
        if (std::abs(n[i]) > std::abs(n[largest])) largest = i;
    }
    const double factor = (n[largest] < 0 ? -1 : 1) / std::sqrt(square);
    result.s = factor * n.head<3>();
    result.n0 = factor * n[3];
    double sum = 0;
    int count = 0;
    for (const auto& [a, b] : landmarks.pairs) {
        const double there =
            static_cast<double>((result.apply(row_of(points, a)) - row_of(points, b)).norm());
        const double back =
            static_cast<double>((result.apply(row_of(points, b)) - row_of(points, a)).norm());
        result.pair_error.push_back(std::sqrt((there * there + back * back) / 2));
        sum += there * there + back * back;
        count += 2;
    }
    for (const int v : landmarks.stationary) {
        const RealVector3 p = row_of(points, v);
        const double off = static_cast<double>((result.apply(p) - p).norm());
        result.stationary_error.push_back(off);
        sum += off * off;
        ++count;
    }
    result.rms = count > 0 ? std::sqrt(sum / count) : 0;
    return result;
}

RealVector3 move_to_great_circle(SpherePoints& points, const AntiInvolution& reflection) {
    const RealVector3 s = reflection.s.cast<Real>();
    const Real length = s.norm();
    boost_points(points, s / length, Real(reflection.n0) / length);
    return s / length;
}

}  // namespace kinequad
