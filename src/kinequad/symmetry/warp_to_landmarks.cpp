#include "kinequad/symmetry/warp_to_landmarks.h"

#include <Eigen/LU>
#include <cmath>

#include "kinequad/core/index.h"
#include "kinequad/core/parallel.h"

namespace kinequad {
namespace {

using RealMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

/// r^1.5: its displacements have continuous derivatives, and never folded the sphere.
Real kernel(const RealVector3& a, const RealVector3& b) {
    const Real r = (a - b).norm();
    return r * sqrt(r);
}

}  // namespace

SpherePoints warp_to_landmarks(const SpherePoints& points, const SphereLandmarks& landmarks,
                               const RealVector3& axis, const Context& context) {
    std::vector<RealVector3> centre;
    std::vector<RealVector3> move;
    for (const auto& [i, j] : landmarks.pairs) {
        const RealVector3 a = points.row(i).transpose();
        const RealVector3 b = points.row(j).transpose();
        const RealVector3 target = (a + mirrored(b, axis)).normalized();
        centre.push_back(a);
        move.push_back(target - a);
        centre.push_back(b);
        move.push_back(mirrored(target, axis) - b);
    }
    for (const int i : landmarks.stationary) {
        const RealVector3 p = points.row(i).transpose();
        centre.push_back(p);
        move.push_back((p - p.dot(axis) * axis).normalized() - p);
    }
    const auto count = static_cast<Eigen::Index>(centre.size());
    RealMatrix A = RealMatrix::Zero(count + 1, count + 1);
    RealMatrix right = RealMatrix::Zero(count + 1, 3);
    for (Eigen::Index i = 0; i < count; ++i) {
        for (Eigen::Index j = 0; j < count; ++j) {
            A(i, j) = kernel(centre[at(i)], centre[at(j)]);
        }
        A(i, count) = A(count, i) = 1;
        right.row(i) = move[at(i)].transpose();
    }
    const RealMatrix weight = A.fullPivLu().solve(right);
    SpherePoints result(points.rows(), 3);
    parallel_for(static_cast<std::size_t>(points.rows()), 512, context,
                 [&](std::size_t begin, std::size_t end) {
                     for (std::size_t v = begin; v < end; ++v) {
                         const auto row = static_cast<Eigen::Index>(v);
                         const RealVector3 x = points.row(row).transpose();
                         RealVector3 moved = x + weight.row(count).transpose();
                         for (Eigen::Index i = 0; i < count; ++i) {
                             moved += kernel(x, centre[at(i)]) * weight.row(i).transpose();
                         }
                         result.row(row) = moved.normalized().transpose();
                     }
                 });
    return result;
}

}  // namespace kinequad
