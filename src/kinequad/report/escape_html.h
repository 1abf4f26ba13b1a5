#pragma once

#include <string>
#include <string_view>

namespace kinequad {

/// `text` such that it stands for itself in HTML and SVG, as content and inside of a quoted
/// attribute: `& < > " '` become references, control characters other than tab and newline and
/// bytes that are no UTF-8 become U+FFFD. All text that comes from the input goes through it.
std::string escape_html(std::string_view text);

}  // namespace kinequad
