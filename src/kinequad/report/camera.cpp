#include "kinequad/report/camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "kinequad/core/error.h"

namespace kinequad {
namespace {

/// From y-up, facing +z, to the axes of the data.
Vector3 oriented(const Vector3& v, UpAxis up) {
    return up == UpAxis::y ? v : Vector3(v.x(), -v.z(), v.y());
}

}  // namespace

Viewpoint named_viewpoint(std::string_view name, UpAxis up) {
    if (name == "front") return {0, 0, up};
    if (name == "left") return {90, 0, up};
    if (name == "back") return {180, 0, up};
    if (name == "right") return {-90, 0, up};
    if (name == "top") return {0, 90, up};
    if (name == "quarter") return {35, 10, up};
    throw InputError(InputFault::usage, "no viewpoint is called '" + std::string(name) +
                                            "'; choose front, back, left, right, top or quarter");
}

Camera fit_camera(const Positions& V, const Viewpoint& viewpoint) {
    const double yaw = viewpoint.yaw_degrees * std::numbers::pi / 180;
    const double pitch = viewpoint.pitch_degrees * std::numbers::pi / 180;
    Camera camera;
    camera.right = oriented({std::cos(yaw), 0, -std::sin(yaw)}, viewpoint.up);
    camera.toward = oriented(
        {std::sin(yaw) * std::cos(pitch), std::sin(pitch), std::cos(yaw) * std::cos(pitch)},
        viewpoint.up);
    camera.up = camera.toward.cross(camera.right);
    if (V.rows() == 0) return camera;
    Eigen::Matrix3d frame;
    frame << camera.right, camera.up, camera.toward;
    const Positions seen = V * frame;
    const Vector3 low = seen.colwise().minCoeff().transpose();
    const Vector3 high = seen.colwise().maxCoeff().transpose();
    camera.center = frame * (0.5 * (low + high));
    // A flat or single-point set still needs a picture of some size.
    const double least = 1e-9 * std::max(1.0, high.cwiseAbs().maxCoeff());
    camera.half_width = std::max(0.5 * (high.x() - low.x()), least);
    camera.half_height = std::max(0.5 * (high.y() - low.y()), least);
    return camera;
}

}  // namespace kinequad
