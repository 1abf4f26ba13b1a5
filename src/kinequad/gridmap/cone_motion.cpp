// Moving the nodes of a cone metric, with a flip where a triangle collapses.
#include <algorithm>
#include <cmath>
#include <limits>

#include "kinequad/core/index.h"
#include "kinequad/gridmap/cone_triangulation.h"

namespace kinequad {
namespace {}  // namespace

/// Time until the area of a triangle vanishes while it shrinks, when its edges change with
/// `velocity`.
double ConeTriangulation::time_to_collapse(int t, const std::vector<Complex>& velocity) const {
    const auto h = at(3 * t);
    const double c0 = cross_product(displacement_[h], displacement_[h + 1]);
    const double c1 = cross_product(velocity[h], displacement_[h + 1]) +
                      cross_product(displacement_[h], velocity[h + 1]);
    const double c2 = cross_product(velocity[h], velocity[h + 1]);
    constexpr double never = std::numeric_limits<double>::infinity();
    if (c0 <= least_cone_area) {
        if (c1 < 0 || (c1 <= 1e-12 && c2 < 0)) return 0;
        return c2 >= 0 || c1 <= 0 ? never : -c1 / c2;
    }
    if (std::abs(c2) < 1e-14 * std::max(c0, std::abs(c1))) return c1 < 0 ? -c0 / c1 : never;
    // Two roots that meet are a collapse too: nodes that pass through one another.
    const double discriminant = c1 * c1 - 4 * c0 * c2;
    if (discriminant < -1e-12 * c1 * c1) return never;
    const double q = -0.5 * (c1 + std::copysign(std::sqrt(std::max(0.0, discriminant)), c1));
    double soonest = never;
    for (const double root : {q / c2, q != 0 ? c0 / q : -1.0}) {
        if (root >= 0) soonest = std::min(soonest, root);
    }
    return soonest;
}

/// Takes back flips, and any drift of the displacements with them.
void ConeTriangulation::undo_flips(const std::vector<int>& flips) {
    // Four flips of one half-edge are the identity, so three undo one.
    for (auto h = flips.rbegin(); h != flips.rend(); ++h) {
        for (int i = 0; i < 3; ++i) flip(*h);
    }
    snap(integers_);
}

bool ConeTriangulation::move(const Eigen::VectorXd& step) {
    std::vector<int> flips;
    std::vector<Complex> velocity(displacement_.size());
    const auto renew_velocity = [&](int t) {
        for (int h = 3 * t; h < 3 * t + 3; ++h) velocity[at(h)] = form_[at(h)].at(step);
    };
    const auto blocked = [&] {
        undo_flips(flips);
        return false;
    };
    for (const int t : alive_) renew_velocity(t);
    double left = 1;
    // A move that takes more winds the nodes around one another.
    const int most_flips = 2 * triangle_count() + 50;
    while (true) {
        int first = -1;
        double soonest = std::numeric_limits<double>::infinity();
        for (const int t : alive_) {
            const double time = time_to_collapse(t, velocity);
            if (time < soonest) {
                soonest = time;
                first = t;
            }
        }
        if (soonest > left * (1 + 1e-12)) break;
        const double advance = std::min(soonest, left);
        for (const int t : alive_) {
            for (int h = 3 * t; h < 3 * t + 3; ++h)
                displacement_[at(h)] += advance * velocity[at(h)];
        }
        left -= advance;
        int longest = 3 * first;
        for (int h = 3 * first; h < 3 * first + 3; ++h) {
            if (std::abs(displacement_[at(h)]) > std::abs(displacement_[at(longest)])) longest = h;
        }
        // The apex has to lie strictly within the edge it ran into.
        if (!can_flip(longest, 1e-7) || static_cast<int>(flips.size()) >= most_flips)
            return blocked();
        const int other = twin_[at(longest)];
        flip(longest);
        flips.push_back(longest);
        renew_velocity(longest / 3);
        renew_velocity(other / 3);
    }
    const Eigen::VectorXd before = integers_;
    snap(integers_ + step);
    for (int i = 0; i < triangle_count(); ++i) {
        if (determinant(i) > least_cone_area) continue;
        integers_ = before;
        return blocked();
    }
    make_delaunay();
    return true;
}

}  // namespace kinequad
