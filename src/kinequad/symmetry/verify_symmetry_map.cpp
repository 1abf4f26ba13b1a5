#include "kinequad/symmetry/verify_symmetry_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kinequad/core/index.h"

namespace kinequad {
namespace {

bool is_valid(const SurfacePoint& point, Eigen::Index triangle_count) {
    return point.triangle >= 0 && point.triangle < triangle_count &&
           point.barycentric.allFinite() && point.barycentric.minCoeff() >= 0 &&
           std::abs(point.barycentric.sum() - 1) < 1e-9;
}

std::string find_problem(const TriangleMesh& mesh, const SymmetryMap& map) {
    const Eigen::Index m = mesh.F.rows();
    if (static_cast<Eigen::Index>(map.vertex_image.size()) != mesh.V.rows() ||
        static_cast<Eigen::Index>(map.centre_image.size()) != m || map.transport.size() != m ||
        map.height.size() != mesh.V.rows()) {
        return "the map is of another mesh";
    }
    std::vector<bool> is_used(map.vertex_image.size(), false);
    for (Eigen::Index i = 0; i < mesh.F.size(); ++i) is_used[at(mesh.F.data()[i])] = true;
    for (std::size_t v = 0; v < map.vertex_image.size(); ++v) {
        if (is_used[v] && !is_valid(map.vertex_image[v], m))
            return fmt::format("vertex {} has no image", v);
    }
    for (std::size_t t = 0; t < map.centre_image.size(); ++t) {
        if (!is_valid(map.centre_image[t], m)) return fmt::format("triangle {} has no image", t);
    }
    if (!map.transport.allFinite()) return "a transport is not finite";
    if (map.height.size() > 0 && map.height.cwiseAbs().minCoeff() == 0) {
        return "a vertex lies on neither side of the curve";
    }
    if (map.stationary.empty()) return "there is no stationary curve";
    for (const auto& line : map.stationary) {
        for (const SurfacePoint& point : line) {
            if (!is_valid(point, m)) return "the stationary curve leaves the surface";
        }
    }
    return {};
}

}  // namespace

Vector3 image_position(const TriangleMesh& mesh, const std::vector<SurfacePoint>& vertex_image,
                       const SurfacePoint& point) {
    Vector3 position = Vector3::Zero();
    for (int k = 0; k < 3; ++k) {
        const SurfacePoint& image = vertex_image[at(mesh.F(point.triangle, k))];
        position += point.barycentric[k] * position_of(image, mesh.V, mesh.F);
    }
    return position;
}

InvolutionError measure_involution(const TriangleMesh& mesh,
                                   const std::vector<SurfacePoint>& vertex_image) {
    InvolutionError error;
    const double percent = 100 / bounding_box_diagonal(mesh.V);
    int mapped = 0;
    for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
        const SurfacePoint& image = vertex_image[at(v)];
        if (image.triangle < 0) continue;
        const Vector3 twice = image_position(mesh, vertex_image, image);
        const double off = percent * (twice - mesh.V.row(v).transpose()).norm();
        error.mean_percent += off;
        ++mapped;
        error.max_percent = std::max(error.max_percent, off);
    }
    error.mean_percent /= std::max(mapped, 1);
    return error;
}

SymmetryReport verify_symmetry_map(const TriangleMesh& mesh, const SymmetryMap& map) {
    SymmetryReport report;
    report.problem = find_problem(mesh, map);
    report.is_complete = report.problem.empty();
    if (!report.is_complete) return report;
    const InvolutionError involution = measure_involution(mesh, map.vertex_image);
    report.involution_mean_percent = involution.mean_percent;
    report.involution_max_percent = involution.max_percent;
    const double percent = 100 / bounding_box_diagonal(mesh.V);
    int points = 0;
    for (const auto& line : map.stationary) {
        const SurfacePoint& first = line.front();
        const SurfacePoint& last = line.back();
        const bool is_closed =
            first.triangle == last.triangle && first.barycentric == last.barycentric;
        ++(is_closed ? report.stationary_loops : report.stationary_paths);
        for (const SurfacePoint& point : line) {
            const Vector3 here = position_of(point, mesh.V, mesh.F);
            report.stationary_percent +=
                percent * (image_position(mesh, map.vertex_image, point) - here).norm();
            ++points;
        }
    }
    report.stationary_percent /= points;
    return report;
}

}  // namespace kinequad
