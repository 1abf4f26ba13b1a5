#pragma once

#include "kinequad/core/types.h"

namespace kinequad::report_detail {

/// sRGB to linear light and back, each channel.
Vector3 linear_from_srgb(const Vector3& color);
Vector3 srgb_from_linear(const Vector3& color);

/// Linear light that a surface of linear colour `albedo` sends to the viewer, lit by a warm light
/// from the upper left, a cool one from the right and a sky. `normal` is in the frame of the
/// picture (x right, y up, z to the viewer), of unit length.
Vector3 shade(const Vector3& albedo, const Vector3& normal);

}  // namespace kinequad::report_detail
