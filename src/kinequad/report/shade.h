#pragma once

#include <cstdint>

#include "kinequad/core/types.h"

namespace kinequad::report_detail {

/// sRGB to linear light, each channel.
Vector3 linear_from_srgb(const Vector3& color);

/// A channel of linear light as an 8-bit sRGB value: the nearest of the 256.
std::uint8_t srgb_byte_from_linear(double channel);

/// Linear light that a surface of linear colour `albedo` sends to the viewer, lit by a warm light
/// from the upper left, a cool one from the right and a sky. `normal` is in the frame of the
/// picture (x right, y up, z to the viewer), of unit length.
Vector3 shade(const Vector3& albedo, const Vector3& normal);

}  // namespace kinequad::report_detail
