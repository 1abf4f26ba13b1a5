#include "kinequad/report/format_report.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "kinequad/core/error.h"
#include "kinequad/io/memory_sequence.h"
#include "kinequad/report/draw_sequences.h"
#include "kinequad/report/drawable_polygons.h"
#include "kinequad/report/encode_base64.h"
#include "kinequad/report/escape_html.h"
#include "support/shapes.h"

namespace kinequad {
namespace {

TEST(EscapeHtml, MakesTextStandForItself) {
    EXPECT_EQ(escape_html("a<b> & \"c\" 'd'"), "a&lt;b&gt; &amp; &quot;c&quot; &#39;d&#39;");
    EXPECT_EQ(escape_html("caf\xC3\xA9 \xE2\x89\xA4 \xF0\x9F\x90\x88"),
              "caf\xC3\xA9 \xE2\x89\xA4 \xF0\x9F\x90\x88");
    EXPECT_EQ(escape_html("tab\tline\n"), "tab\tline\n");
}

TEST(EscapeHtml, ReplacesWhatIsNoText) {
    const std::string unknown = "\xEF\xBF\xBD";
    EXPECT_EQ(escape_html(std::string("a\0b\x01", 4)), "a" + unknown + "b" + unknown);
    EXPECT_EQ(escape_html("\xFF"), unknown);
    EXPECT_EQ(escape_html("\xC3"), unknown);                              // cut off
    EXPECT_EQ(escape_html("\xC0\xAF"), unknown + unknown);                // overlong slash
    EXPECT_EQ(escape_html("\xED\xA0\x80"), unknown + unknown + unknown);  // half a surrogate pair
    EXPECT_EQ(escape_html("\xE0\x80\xBC"), unknown + unknown + unknown);  // overlong less-than
}

TEST(EncodeBase64, AgreesWithTheStandard) {
    // RFC 4648, section 10.
    for (const auto& [bytes, text] : {std::pair{"", ""},
                                      {"f", "Zg=="},
                                      {"fo", "Zm8="},
                                      {"foo", "Zm9v"},
                                      {"foob", "Zm9vYg=="},
                                      {"fooba", "Zm9vYmE="},
                                      {"foobar", "Zm9vYmFy"}}) {
        EXPECT_EQ(encode_base64(bytes), text);
    }
    EXPECT_EQ(encode_base64("\xFF\xFE\xFD"), "//79");
}

TEST(DrawablePolygons, KeepsQuadsAndCutsLargerFaces) {
    Polygons faces;
    faces.add(std::vector<int>{0, 1, 2});
    faces.add(std::vector<int>{0, 1, 2, 3});
    faces.add(std::vector<int>{0, 1, 2, 3, 4});
    Quads expected(5, 4);
    expected << 0, 1, 2, -1, 0, 1, 2, 3, 0, 1, 2, -1, 0, 2, 3, -1, 0, 3, 4, -1;
    EXPECT_EQ(drawable_polygons(faces), expected);
    faces.add(std::vector<int>{0, 1});
    EXPECT_THROW(drawable_polygons(faces), InputError);
}

Report small_report() {
    Report report;
    report.title = "a <script> & \"more\"";
    report.lead = "Lead.";
    report.facts = {{"input", "</dl><b>"}};
    for (const char* name : {"one", "</script><script>alert(1)</script>"}) {
        ComparedMethod method{name, "A <i>method</i>.", {}};
        for (int j = 0; j < 3; ++j) method.metrics.frames.emplace_back().frame = j;
        method.metrics.frames[1].shape.angle_deviation_mean = 5;
        report.comparison.methods.push_back(std::move(method));
    }
    report.pictures = {{2, {{"one", Image{4, 3, std::vector<std::uint8_t>(36, 200)}}}}};
    report.options = {{"one"}, {{"alpha", {"0.5"}}}};
    report.footer = "Kinequad";
    return report;
}

std::string data_of(const std::string& page) {
    const std::string begin = "<script type=\"application/json\" id=\"data\">";
    const std::size_t at = page.find(begin) + begin.size();
    return page.substr(at, page.find("</script>", at) - at);
}

TEST(FormatReport, EscapesAllTextFromOutside) {
    const std::string page = format_report(small_report());
    EXPECT_EQ(page.find("alert(1)</script>"), std::string::npos);
    EXPECT_EQ(page.find("</dl><b>"), std::string::npos);
    EXPECT_EQ(page.find("<i>method"), std::string::npos);
    EXPECT_NE(page.find("<title>a &lt;script&gt; &amp; &quot;more&quot;</title>"),
              std::string::npos);
    const auto data = nlohmann::json::parse(data_of(page));
    EXPECT_EQ(data["methods"][1]["name"], "</script><script>alert(1)</script>");
}

TEST(FormatReport, NeedsNoOtherFile) {
    const std::string page = format_report(small_report());
    for (const char* part : {"http://", "https://", "src=\"//", "@import", "url("}) {
        EXPECT_EQ(page.find(part), std::string::npos) << part;
    }
    EXPECT_NE(page.find("src=\"data:image/png;base64,iVBORw0KGgo"), std::string::npos);
}

TEST(FormatReport, HoldsTheValuesOfEveryFrame) {
    const auto data = nlohmann::json::parse(data_of(format_report(small_report())));
    EXPECT_EQ(data["frames"], (nlohmann::json{0, 1, 2}));
    EXPECT_EQ(data["plots"][0]["lines"][0], (nlohmann::json{0.0, 5.0, 0.0}));
    EXPECT_GE(data["plots"][0]["high"].get<double>(), 5);
}

TEST(FormatReport, IsCompleteWithoutMeasures) {
    Report report = small_report();
    for (ComparedMethod& method : report.comparison.methods) {
        method.metrics.frames.clear();
        method.metrics.has_distance = false;
        method.metrics.stretch_alignment_degrees = ComparedMethod::unknown;
    }
    const std::string page = format_report(report);
    EXPECT_EQ(page.find("<polyline"), std::string::npos);
    EXPECT_EQ(page.find("nan"), std::string::npos);
    EXPECT_NE(page.find("vertices"), std::string::npos);
}

TEST(DrawSequences, DrawsAllMeshesOfAFrameAtOneSize) {
    const TriangleMesh torus = test::torus(12, 8);
    std::vector<Positions> frames;
    for (int j = 0; j < 9; ++j) {
        frames.push_back(torus.V);
        frames.back().col(1) *= 1 + 0.1 * j;
    }
    const MemorySequence input(torus.F, frames);
    const std::vector<DrawnSequence> sequences = {
        {"a", follow_frames(make_polygons(torus.F), input)},
        {"b", follow_frames(make_polygons(torus.F), input)}};
    PictureOptions options;
    options.pixels = 5000;
    const auto pictures = draw_sequences(input, sequences, options, Context{});
    ASSERT_EQ(pictures.size(), 4U);
    std::vector<int> shown;
    for (const ReportPictures& row : pictures) {
        shown.push_back(row.frame);
        ASSERT_EQ(row.panels.size(), 2U);
        EXPECT_EQ(row.panels[0].second.rgb, row.panels[1].second.rgb);
        EXPECT_EQ(row.panels[0].second.width, pictures[0].panels[0].second.width);
        EXPECT_NEAR(row.panels[0].second.width * row.panels[0].second.height, 5000, 200);
    }
    EXPECT_EQ(shown, (std::vector<int>{0, 3, 5, 8}));
    options.frames = {9};
    EXPECT_THROW(draw_sequences(input, sequences, options, Context{}), InputError);
}

}  // namespace
}  // namespace kinequad
