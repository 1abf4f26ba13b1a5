#include "kinequad/mesh/flat_triangles.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace kinequad {

bool is_flat_triangle(const Triangles& F, const Positions& V, int t) {
    constexpr double flatness = 1e-12;
    const Vector3 a = V.row(F(t, 0)).transpose();
    const Vector3 u = V.row(F(t, 1)).transpose() - a;
    const Vector3 v = V.row(F(t, 2)).transpose() - a;
    // Scaled first, so that squares of tiny and huge lengths stay in range.
    const double longest =
        std::max({u.cwiseAbs().maxCoeff(), v.cwiseAbs().maxCoeff(), (u - v).cwiseAbs().maxCoeff()});
    if (!(longest > 0)) return true;
    return (u / longest).cross(v / longest).norm() <= flatness;
}

}  // namespace kinequad
