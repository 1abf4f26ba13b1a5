#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kinequad/core/types.h"

namespace kinequad {

/// Red, green and blue in [0, 1], encoded as sRGB.
using Color = Vector3;

/// A picture of 8-bit sRGB pixels, rows from top to bottom, three bytes a pixel.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgb;  ///< 3 * width * height

    /// Index in `rgb` of the red byte of a pixel; `x` runs right, `y` runs down.
    std::size_t offset(int x, int y) const {
        return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                    static_cast<std::size_t>(x));
    }
};

}  // namespace kinequad
