#pragma once

#include <string>
#include <vector>

#include "kinequad/report/axis.h"

namespace kinequad {

/// One measure against the frames, a line a method.
struct Plot {
    struct Line {
        std::string name;
        std::string style;           ///< class in report.css: "main", "s0" to "s5"
        std::vector<double> values;  ///< one a frame; what is not finite is a gap
    };
    std::string title;
    std::string unit;  ///< of the values; may be empty
    std::vector<int> frames;
    std::vector<Line> lines;
};

/// The vertical axis on which all values of a plot have room.
Axis axis_of(const Plot& plot);

/// The plot as an HTML figure with inline SVG, complete without any script. `index` is its number
/// on the page. Stretched lines keep their width and labels are text beside the SVG, so that it is
/// as legible on a phone as on a wide screen.
std::string format_plot(const Plot& plot, int index);

}  // namespace kinequad
