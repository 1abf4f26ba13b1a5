#pragma once

#include <string_view>
#include <vector>

#include "kinequad/core/types.h"

namespace kinequad {

/// The axis of the data that points up in the picture. With `y`, a figure faces +z; with `z`, -y.
enum class UpAxis { y, z };

/// Where a picture is taken from: the figure's front turned by `yaw_degrees` towards its left side
/// (+x), raised by `pitch_degrees`.
struct Viewpoint {
    double yaw_degrees = 35;
    double pitch_degrees = 10;
    UpAxis up = UpAxis::y;
};

/// The viewpoint called "front", "back", "left", "right", "top" or "quarter".
/// Throws `InputError` (usage) for another name.
Viewpoint named_viewpoint(std::string_view name, UpAxis up = UpAxis::y);

/// An orthographic camera: three unit vectors of a right-handed frame in the units of the data, the
/// point in the middle of the picture, and half the size of the box that has to be in it.
struct Camera {
    Vector3 right = Vector3::UnitX();
    Vector3 up = Vector3::UnitY();
    Vector3 toward = Vector3::UnitZ();  ///< from the scene to the viewer
    Vector3 center = Vector3::Zero();
    double half_width = 1;
    double half_height = 1;
};

/// Camera at `viewpoint` in which every point of `V` (n x 3) is just in the picture. Give it the
/// points of several frames or meshes stacked to have one framing for all of them.
Camera fit_camera(const Positions& V, const Viewpoint& viewpoint);

/// The camera in which all is in the picture that is in the picture of `a` or `b`, two cameras at
/// the same viewpoint.
Camera unite_cameras(const Camera& a, const Camera& b);

/// `count` cameras that go once around `V` (n x 3), the first at `viewpoint`, each a step further
/// to the figure's left, all with the same middle and the same size of the picture.
std::vector<Camera> turntable_cameras(const Positions& V, const Viewpoint& viewpoint, int count);

}  // namespace kinequad
