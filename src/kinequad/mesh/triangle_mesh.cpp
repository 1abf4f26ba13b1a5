#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {

double bounding_box_diagonal(const Positions& V) {
    if (V.rows() == 0) return 0;
    return (V.colwise().maxCoeff() - V.colwise().minCoeff()).norm();
}

Vector3 position_of(const SurfacePoint& point, const Positions& V, const Triangles& F) {
    const auto corners = F.row(point.triangle);
    return (point.barycentric[0] * V.row(corners[0]) + point.barycentric[1] * V.row(corners[1]) +
            point.barycentric[2] * V.row(corners[2]))
        .transpose();
}

}  // namespace kinequad
