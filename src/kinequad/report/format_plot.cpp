#include "kinequad/report/format_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>

#include "kinequad/report/escape_html.h"

namespace kinequad {
namespace {

constexpr double side = 1000;  ///< of the SVG's own square of coordinates

/// The runs of finite values, each as the points of a polyline.
std::vector<std::string> polylines(const Plot::Line& line, const Axis& axis) {
    std::vector<std::string> runs;
    const std::size_t count = line.values.size();
    bool is_open = false;
    for (std::size_t i = 0; i < count; ++i) {
        if (!std::isfinite(line.values[i])) {
            is_open = false;
            continue;
        }
        const double x = count > 1 ? side * double(i) / double(count - 1) : 0.5 * side;
        const double y = side * (1 - axis.place(line.values[i]));
        const std::string point = fmt::format("{:.1f},{:.1f}", x, y);
        if (is_open) {
            runs.back() += ' ';
            runs.back() += point;
        } else {
            // A single point is drawn as the round end of a line without length.
            runs.push_back(fmt::format("{0} {0}", point));
        }
        is_open = true;
    }
    return runs;
}

std::string description(const Plot& plot, const Axis& axis) {
    std::string text = fmt::format("{} against the frame, frames {} to {}, from {} to {} {}.",
                                   plot.title, plot.frames.front(), plot.frames.back(),
                                   axis.label(axis.low), axis.label(axis.high), plot.unit);
    for (const Plot::Line& line : plot.lines) {
        double sum = 0;
        int count = 0;
        for (const double value : line.values) {
            if (!std::isfinite(value)) continue;
            sum += value;
            ++count;
        }
        if (count > 0) text += fmt::format(" {}: mean {:.3g}.", line.name, sum / count);
    }
    return text;
}

}  // namespace

Axis axis_of(const Plot& plot) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Plot::Line& line : plot.lines) {
        for (const double value : line.values) {
            if (!std::isfinite(value)) continue;
            low = std::min(low, value);
            high = std::max(high, value);
        }
    }
    return low <= high ? value_axis(low, high, 8) : value_axis(0, 1, 8);
}

std::string format_plot(const Plot& plot, int index) {
    const Axis values = axis_of(plot);
    const Axis frames = frame_axis(plot.frames.front(), plot.frames.back(), 6);
    std::string text;
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "<figure class=\"plot\" data-plot=\"{}\">\n<figcaption><b>{}</b>", index,
                   escape_html(plot.title));
    if (!plot.unit.empty()) {
        fmt::format_to(out, " <span class=\"unit\">{}</span>", escape_html(plot.unit));
    }
    fmt::format_to(out,
                   "</figcaption>\n<div class=\"plot-box\">\n<svg viewBox=\"0 0 {0} {0}\" "
                   "preserveAspectRatio=\"none\" role=\"img\">\n<title>{1}</title>\n"
                   "<g class=\"grid\">\n",
                   side, escape_html(description(plot, values)));
    for (const double tick : values.ticks) {
        const double y = side * (1 - values.place(tick));
        fmt::format_to(out, "<line{} x1=\"0\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>\n",
                       tick == values.low ? " class=\"base\"" : "", side, y, y);
    }
    text += "</g>\n";
    // The last method is drawn on top.
    for (std::size_t m = 0; m < plot.lines.size(); ++m) {
        for (const std::string& points : polylines(plot.lines[m], values)) {
            fmt::format_to(out, "<polyline class=\"line {}\" data-method=\"{}\" points=\"{}\"/>\n",
                           plot.lines[m].style, m, points);
        }
    }
    text += "</svg>\n";
    for (const double tick : values.ticks) {
        fmt::format_to(out, "<span class=\"tick y\" style=\"bottom:{:.2f}%\">{}</span>\n",
                       100 * values.place(tick), values.label(tick));
    }
    const bool is_single = plot.frames.size() == 1;
    for (const double tick : frames.ticks) {
        fmt::format_to(out, "<span class=\"tick x\" style=\"left:{:.2f}%\">{}</span>\n",
                       is_single ? 50.0 : 100 * frames.place(tick), frames.label(tick));
    }
    text += "</div>\n<p class=\"axis\">frame</p>\n</figure>\n";
    return text;
}

}  // namespace kinequad
