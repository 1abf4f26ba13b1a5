#include "report_options.h"

#include <CLI/CLI.hpp>

namespace kinequad::app {

void ReportOptions::add_options(CLI::App& command) {
    command.add_flag("--no-report", no_report_, "Do not write report.html");
    command
        .add_option("--pictures", frames_,
                    "Frames that the report shows pictures of, counted from 0, as 0,40,80 [four "
                    "spread over the sequence]")
        ->delimiter(',')
        ->check(CLI::NonNegativeNumber);
    command
        .add_option("--view", view_,
                    "Where the report's pictures are seen from: front, back, left, right, top or "
                    "quarter")
        ->check(CLI::IsMember({"front", "back", "left", "right", "top", "quarter"}))
        ->capture_default_str();
    command.add_option("--up", up_, "Axis of the data that points up in pictures: y or z")
        ->check(CLI::IsMember({"y", "z"}))
        ->capture_default_str();
}

PictureOptions ReportOptions::pictures(int frame_count) const {
    PictureOptions options;
    options.frames = frames_;
    options.viewpoint = named_viewpoint(view_, up_ == "z" ? UpAxis::z : UpAxis::y);
    require_frames_exist(options, frame_count);
    return options;
}

}  // namespace kinequad::app
