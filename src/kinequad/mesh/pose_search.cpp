#include "kinequad/mesh/pose_search.h"

#include <algorithm>
#include <array>
#include <limits>

namespace kinequad {
namespace {

double dot(const PoseSearch::Place& a, const PoseSearch::Place& b) {
    return a.cwiseProduct(b).sum();
}

}  // namespace

PoseSearch::Place PoseSearch::place(int v) const {
    Place result(3, static_cast<Eigen::Index>(poses_.size()));
    for (std::size_t j = 0; j < poses_.size(); ++j) {
        result.col(static_cast<Eigen::Index>(j)) = poses_[j].row(v).transpose();
    }
    return result;
}

PoseSearch::Place PoseSearch::place(const SurfacePoint& point) const {
    Place sum = Place::Zero(3, static_cast<Eigen::Index>(poses_.size()));
    for (int k = 0; k < 3; ++k) {
        if (point.barycentric[k] == 0) continue;
        sum += point.barycentric[k] * place(F_(point.triangle, k));
    }
    return sum;
}

SurfacePoint PoseSearch::find(const Place& wanted, int start) const {
    Found best = nearest_in(start, wanted);
    for (bool has_moved = true; has_moved;) {
        has_moved = false;
        const int middle = best.point.triangle;
        for (int k = 0; k < 3; ++k) {
            for (const int h : outgoing_half_edges(topology_, F_(middle, k))) {
                const Found found = nearest_in(h / 3, wanted);
                if (found.distance2 < best.distance2) {
                    best = found;
                    has_moved = true;
                }
            }
        }
    }
    return best.point;
}

/// As `closest_point_on_triangle`, in the space of all poses together.
PoseSearch::Found PoseSearch::nearest_in(int t, const Place& wanted) const {
    const std::array<Place, 3> corner = {place(F_(t, 0)), place(F_(t, 1)), place(F_(t, 2))};
    const Place ab = corner[1] - corner[0];
    const Place ac = corner[2] - corner[0];
    const Place ap = wanted - corner[0];
    const double bb = dot(ab, ab);
    const double cc = dot(ac, ac);
    const double bc = dot(ab, ac);
    const double determinant = bb * cc - bc * bc;
    const double v = cc * dot(ap, ab) - bc * dot(ap, ac);
    const double w = bb * dot(ap, ac) - bc * dot(ap, ab);
    Found best{{t, Vector3::UnitX()}, std::numeric_limits<double>::infinity()};
    const auto look = [&](const Vector3& b) {
        const double distance2 =
            (wanted - b[0] * corner[0] - b[1] * corner[1] - b[2] * corner[2]).squaredNorm();
        if (distance2 < best.distance2) best = {{t, b}, distance2};
    };
    if (determinant > 1e-12 * bb * cc && v >= 0 && w >= 0 && v + w <= determinant) {
        const double beta = v / determinant;
        const double gamma = w / determinant;
        look({std::max(0.0, 1 - beta - gamma), beta, gamma});
        return best;
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3;
        const Place side = corner[next] - corner[k];
        const double length2 = dot(side, side);
        const double along = dot(wanted - corner[k], side);
        const double share = length2 > 0 ? std::clamp(along / length2, 0.0, 1.0) : 0.0;
        Vector3 b = Vector3::Zero();
        b[static_cast<Eigen::Index>(k)] = 1 - share;
        b[static_cast<Eigen::Index>(next)] = share;
        look(b);
    }
    return best;
}

}  // namespace kinequad
