#pragma once

#include <string_view>

#include "kinequad/report/image.h"

namespace kinequad {

/// Width of one line of text in pixels, for capitals `height` pixels tall.
double text_width(std::string_view text, double height);

/// `image` with one line of text in `color`, anti-aliased, in a built-in stroke font: capitals,
/// small letters as small capitals, digits and common signs; other characters show as spaces.
/// `left` and `baseline` are in pixels.
Image draw_text(Image image, std::string_view text, double left, double baseline, double height,
                const Color& color);

}  // namespace kinequad
