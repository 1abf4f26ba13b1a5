#include "kinequad/measure/stretch_alignment.h"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "kinequad/core/parallel.h"

namespace kinequad {
namespace {

constexpr std::size_t aligned_block_size = 512;
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

StretchAlignment::StretchAlignment(const StretchReference& reference, const Context& context)
    : F_(reference.F) {
    const QuadCrosses crosses(reference);
    const auto m = static_cast<std::size_t>(F_.rows());
    inverse_rest_.resize(m);
    area_ = Eigen::VectorXd::Zero(F_.rows());
    cross_ = Eigen::VectorXcd::Zero(F_.rows());
    parallel_for(m, aligned_block_size, context, [&](std::size_t begin, std::size_t end) {
        int hint = -1;
        for (std::size_t i = begin; i < end; ++i) {
            const auto t = static_cast<Eigen::Index>(i);
            const Eigen::Matrix2d rest = crosses.rest_shape(static_cast<int>(i));
            inverse_rest_[i] = rest.inverse();
            if (!inverse_rest_[i].allFinite()) continue;
            const QuadCrosses::Cross cross =
                crosses.find({static_cast<int>(i), Vector3::Constant(1.0 / 3)}, hint);
            hint = cross.hint;
            cross_[t] = cross.fourth_power;
            if (cross_[t] != Complex(0)) area_[t] = 0.5 * std::abs(rest.determinant());
        }
    });
}

void StretchAlignment::add_frame(const Positions& V, const Context& context) {
    const auto m = static_cast<std::size_t>(F_.rows());
    // Two sums a block, added up in the order of the blocks.
    std::vector<std::array<double, 2>> sums((m + aligned_block_size - 1) / aligned_block_size,
                                            {0, 0});
    parallel_for(m, aligned_block_size, context, [&](std::size_t begin, std::size_t end) {
        auto& [weight, weighted] = sums[begin / aligned_block_size];
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
