#pragma once

#include <string>
#include <vector>

#include "kinequad/report/draw_sequences.h"

namespace CLI {
class App;
}

namespace kinequad::app {

/// Whether a command writes report.html, and which pictures are in it.
class ReportOptions {
public:
    /// Adds --no-report, --pictures, --view and --up.
    void add_options(CLI::App& command);
    bool is_wanted() const { return !no_report_; }
    /// Which pictures are wanted. Throws `InputError` (usage) where a frame is not one of
    /// `frame_count`.
    PictureOptions pictures(int frame_count) const;

private:
    bool no_report_ = false;
    std::vector<int> frames_;
    std::string view_ = "quarter";
    std::string up_ = "y";
};

}  // namespace kinequad::app
