#pragma once

#include <string_view>

namespace kinequad::report_detail {

/// The files `page/report.css` and `page/report.js`, built in.
extern const std::string_view page_style;
extern const std::string_view page_script;

}  // namespace kinequad::report_detail
