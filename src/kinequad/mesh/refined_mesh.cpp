#include "kinequad/mesh/refined_mesh.h"

#include <Eigen/LU>
#include <algorithm>
#include <numeric>

#include "kinequad/core/index.h"
#include "kinequad/mesh/topology.h"

namespace kinequad {

RefinedMesh as_refined_mesh(const Triangles& F, int vertex_count) {
    RefinedMesh mesh;
    mesh.F = F;
    mesh.vertex_count = vertex_count;
    mesh.parent.resize(at(F.rows()));
    std::iota(mesh.parent.begin(), mesh.parent.end(), 0);
    mesh.barycentric = Eigen::Matrix3d::Identity().replicate(F.rows(), 1);
    return mesh;
}

std::vector<SurfacePoint> vertex_points(const RefinedMesh& mesh) {
    std::vector<SurfacePoint> points(at(mesh.vertex_count));
    for (Eigen::Index corner = 0; corner < mesh.F.size(); ++corner) {
        SurfacePoint& point = points[at(mesh.F.data()[corner])];
        if (point.triangle >= 0) continue;
        point.triangle = mesh.parent[at(corner / 3)];
        point.barycentric = mesh.barycentric.row(corner).transpose();
    }
    return points;
}

SurfacePoint point_of_input(const RefinedMesh& mesh, const SurfacePoint& point) {
    const Eigen::Index corner = 3 * static_cast<Eigen::Index>(point.triangle);
    const Vector3 sum = mesh.barycentric.middleRows<3>(corner).transpose() * point.barycentric;
    return {mesh.parent[at(point.triangle)], sum / sum.sum()};
}

RefinementSearch::RefinementSearch(const RefinedMesh& mesh) : mesh_(mesh) {
    order_.resize(mesh.parent.size());
    std::iota(order_.begin(), order_.end(), 0);
    const auto parent_of = [&](int t) { return mesh.parent[at(t)]; };
    std::stable_sort(order_.begin(), order_.end(),
                     [&](int a, int b) { return parent_of(a) < parent_of(b); });
    for (std::size_t i = 0; i < order_.size(); ++i) {
        while (static_cast<int>(start_.size()) <= parent_of(order_[i])) {
            start_.push_back(static_cast<int>(i));
        }
    }
    start_.push_back(static_cast<int>(order_.size()));
}

SurfacePoint RefinementSearch::find(const SurfacePoint& point) const {
    constexpr double rounding = 1e-9;
    const auto parent = at(point.triangle);
    SurfacePoint found;
    for (int i = start_[parent]; i < start_[parent + 1]; ++i) {
        const int t = order_[at(i)];
        const Eigen::Matrix3d corners =
            mesh_.barycentric.middleRows<3>(3 * static_cast<Eigen::Index>(t)).transpose();
        const Vector3 barycentric = corners.inverse() * point.barycentric;
        if (!barycentric.allFinite()) continue;
        if (found.triangle < 0 || barycentric.minCoeff() > found.barycentric.minCoeff()) {
            found = {t, barycentric};
        }
    }
    for (int k = 0; k < 3; ++k) {
        if (found.barycentric[k] < rounding) found.barycentric[k] = 0;
    }
    found.barycentric /= found.barycentric.sum();
    return found;
}

RefinedMesh as_refinement_of_input(const RefinedMesh& outer, const RefinedMesh& inner) {
    RefinedMesh mesh = inner;
    for (Eigen::Index corner = 0; corner < inner.F.size(); ++corner) {
        const auto t = at(corner / 3);
        const SurfacePoint point =
            point_of_input(outer, {inner.parent[t], inner.barycentric.row(corner).transpose()});
        mesh.barycentric.row(corner) = point.barycentric.transpose();
        mesh.parent[t] = point.triangle;
    }
    return mesh;
}

int side_of_parent(const RefinedMesh& mesh, int h) {
    const int next = Topology::next(h);
    for (int k = 0; k < 3; ++k) {
        if (mesh.barycentric(h, k) == 0 && mesh.barycentric(next, k) == 0)
            return 3 * mesh.parent[at(h / 3)] + (k + 1) % 3;
    }
    return -1;
}

}  // namespace kinequad
