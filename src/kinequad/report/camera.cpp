#include "kinequad/report/camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

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

Camera unite_cameras(const Camera& a, const Camera& b) {
    Camera camera = a;
    const Vector3 between = b.center - a.center;
    // Along an axis of the picture, counted from the middle of `a`: [low, high].
    const auto range_along = [&](const Vector3& axis, double half_a, double half_b) {
        const double offset = between.dot(axis);
        return std::pair(std::min(-half_a, offset - half_b), std::max(half_a, offset + half_b));
    };
    const auto [left, right] = range_along(a.right, a.half_width, b.half_width);
    const auto [bottom, top] = range_along(a.up, a.half_height, b.half_height);
    camera.center += 0.5 * (left + right) * a.right + 0.5 * (bottom + top) * a.up;
    camera.half_width = 0.5 * (right - left);
    camera.half_height = 0.5 * (top - bottom);
    return camera;
}

std::vector<Camera> turntable_cameras(const Positions& V, const Viewpoint& viewpoint, int count) {
    std::vector<Camera> cameras;
    Vector3 center = Vector3::Zero();
    if (V.rows() > 0) {
        const Vector3 low = V.colwise().minCoeff().transpose();
        const Vector3 high = V.colwise().maxCoeff().transpose();
        center = 0.5 * (low + high);
    }
    double half_width = 0;
    double half_height = 0;
    for (int k = 0; k < count; ++k) {
        Viewpoint turned = viewpoint;
        turned.yaw_degrees += 360.0 * k / count;
        Camera camera = fit_camera(V, turned);
        const Vector3 off = camera.center - center;
        half_width = std::max(half_width, camera.half_width + std::abs(off.dot(camera.right)));
        half_height = std::max(half_height, camera.half_height + std::abs(off.dot(camera.up)));
        camera.center = center;
        cameras.push_back(camera);
    }
    for (Camera& camera : cameras) {
        camera.half_width = half_width;
        camera.half_height = half_height;
    }
    return cameras;
}

}  // namespace kinequad
