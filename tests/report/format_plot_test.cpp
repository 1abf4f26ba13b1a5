#include "kinequad/report/format_plot.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace kinequad {
namespace {

int count(const std::string& text, const std::string& part) {
    int found = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++found;
    return found;
}

Plot plot_of(const std::vector<double>& values) {
    Plot plot{"Angle", "degrees", {}, {{"a<b", "main", values}}};
    for (std::size_t i = 0; i < values.size(); ++i) plot.frames.push_back(static_cast<int>(i));
    return plot;
}

TEST(FormatPlot, DrawsALineThroughItsValues) {
    const std::string text = format_plot(plot_of({0, 10, 5}), 0);
    EXPECT_EQ(count(text, "<polyline"), 1);
    EXPECT_NE(text.find("points=\"0.0,1000.0 0.0,1000.0 500.0,0.0 1000.0,500.0\""),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("a&lt;b"), std::string::npos);
    EXPECT_EQ(text.find("a<b"), std::string::npos);
}

TEST(FormatPlot, LeavesGapsWhereNothingIsKnown) {
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    const std::string text = format_plot(plot_of({1, 2, unknown, 3, unknown}), 0);
    EXPECT_EQ(count(text, "<polyline"), 2);
    EXPECT_EQ(count(text, "nan"), 0);
    EXPECT_EQ(count(format_plot(plot_of({unknown, unknown}), 0), "<polyline"), 0);
}

TEST(FormatPlot, ShowsASingleFrameAsADot) {
    const std::string text = format_plot(plot_of({7}), 0);
    EXPECT_EQ(count(text, "<polyline"), 1);
    EXPECT_NE(text.find("points=\"500.0,"), std::string::npos) << text;
    EXPECT_EQ(count(text, "tick x"), 1);
}

TEST(FormatPlot, HasAxesWithUnits) {
    const std::string text = format_plot(plot_of({5.9, 10.7}), 3);
    EXPECT_NE(text.find("data-plot=\"3\""), std::string::npos);
    EXPECT_NE(text.find("degrees"), std::string::npos);
    EXPECT_GE(count(text, "tick y"), 5);
    EXPECT_NE(text.find(">frame<"), std::string::npos);
}

}  // namespace
}  // namespace kinequad
