#include "kinequad/mesh/refined_mesh.h"

#include <numeric>

namespace kinequad {

RefinedMesh as_refined_mesh(const Triangles& F, int vertex_count) {
    RefinedMesh mesh;
    mesh.F = F;
    mesh.vertex_count = vertex_count;
    mesh.parent.resize(static_cast<std::size_t>(F.rows()));
    std::iota(mesh.parent.begin(), mesh.parent.end(), 0);
    mesh.barycentric = Eigen::Matrix3d::Identity().replicate(F.rows(), 1);
    return mesh;
}

std::vector<SurfacePoint> vertex_points(const RefinedMesh& mesh) {
    std::vector<SurfacePoint> points(static_cast<std::size_t>(mesh.vertex_count));
    for (Eigen::Index corner = 0; corner < mesh.F.size(); ++corner) {
        SurfacePoint& point = points[static_cast<std::size_t>(mesh.F.data()[corner])];
        if (point.triangle >= 0) continue;
        point.triangle = mesh.parent[static_cast<std::size_t>(corner / 3)];
        point.barycentric = mesh.barycentric.row(corner).transpose();
    }
    return points;
}

SurfacePoint point_of_input(const RefinedMesh& mesh, const SurfacePoint& point) {
    const Eigen::Index corner = 3 * static_cast<Eigen::Index>(point.triangle);
    const Vector3 sum = mesh.barycentric.middleRows<3>(corner).transpose() * point.barycentric;
    return {mesh.parent[static_cast<std::size_t>(point.triangle)], sum / sum.sum()};
}

RefinedMesh as_refinement_of_input(const RefinedMesh& outer, const RefinedMesh& inner) {
    RefinedMesh mesh = inner;
    for (Eigen::Index corner = 0; corner < inner.F.size(); ++corner) {
        const auto t = static_cast<std::size_t>(corner / 3);
        const SurfacePoint point =
            point_of_input(outer, {inner.parent[t], inner.barycentric.row(corner).transpose()});
        mesh.barycentric.row(corner) = point.barycentric.transpose();
        mesh.parent[t] = point.triangle;
    }
    return mesh;
}

int side_of_parent(const RefinedMesh& mesh, int h) {
    const int next = h % 3 == 2 ? h - 2 : h + 1;
    for (int k = 0; k < 3; ++k) {
        if (mesh.barycentric(h, k) == 0 && mesh.barycentric(next, k) == 0)
            return 3 * mesh.parent[static_cast<std::size_t>(h / 3)] + (k + 1) % 3;
    }
    return -1;
}

}  // namespace kinequad
