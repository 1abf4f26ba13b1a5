#include "kinequad/report/format_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "kinequad/measure/format_metrics.h"
#include "kinequad/report/encode_base64.h"
#include "kinequad/report/escape_html.h"
#include "kinequad/report/format_plot.h"
#include "kinequad/report/page_assets.h"
#include "kinequad/report/write_png.h"

namespace kinequad {
namespace {

using report_detail::page_script;
using report_detail::page_style;

constexpr int style_count = 6;  ///< classes s0 to s5 of report.css

struct PlottedMeasure {
    std::string_view name;  ///< as in `MeasureSummary`
    std::string_view title;
    std::string_view unit;
};

/// Figures 3 and 4 of the paper, and two more.
constexpr PlottedMeasure plotted[] = {
    {"angle_deviation_mean", "Average angle deviation", "degrees"},
    {"hausdorff_percent", "Hausdorff distance", "% of the diagonal"},
    {"mean_distance_percent", "Mean distance", "% of the diagonal"},
    {"scaled_jacobian_mean", "Scaled Jacobian, mean over the quads", ""},
};

struct Definition {
    std::string_view term;
    std::string_view text;
};

constexpr Definition definitions[] = {
    {"singular vertices",
     "Vertices where not four quads meet (on the boundary: not two). The proportion is their share "
     "of all vertices."},
    {"angle deviation",
     "|angle − 90°| between the two sides at a corner, in space: the mean over all corners of all "
     "quads of a frame."},
    {"Hausdorff distance",
     "Largest distance of a point of one surface from the other, in both directions, in % of the "
     "diagonal of the input's bounding box in that frame. It is found to within half a per cent, "
     "and is never larger than the true one by more than rounding."},
    {"mean distance",
     "Area-weighted mean of the distances of all points of one surface from the other; the larger "
     "of the two directions."},
    {"scaled Jacobian",
     "Of a quad, the least of its corners' sines, seen along its normal: 1 for a rectangle, 0 or "
     "less for a folded quad. “Smallest” is that of the worst quad in a frame."},
    {"symmetry error",
     "Angle between the mirrored edges of the quad over a point and those of the quad over its "
     "mirror point, modulo 90°, mean over the surface. 0° is a symmetric mesh, 22.5° one that does "
     "not care."},
    {"stretch alignment",
     "Angle between the edges and the direction in which the motion stretches the surface, modulo "
     "90°, weighted by stretch. 0° follows the motion, 22.5° does not care."},
    {"CPU time", "All threads together, for making the quads; measuring them is not counted."},
    {"mean, worst frame",
     "Over all measured frames: the mean of the frames' values, and the value of the worst frame."},
};

std::string style_of(const Report& report, std::size_t method) {
    const auto highlighted = static_cast<std::size_t>(report.highlighted);
    if (report.highlighted >= 0 && method == highlighted) return "main";
    const std::size_t number =
        report.highlighted >= 0 && method > highlighted ? method - 1 : method;
    return fmt::format("s{}", number % style_count);
}

std::string key_of(const Report& report, std::size_t method) {
    return fmt::format(
        "<svg class=\"key {}\" viewBox=\"0 0 30 10\" preserveAspectRatio=\"none\" "
        "aria-hidden=\"true\"><line x1=\"1\" x2=\"29\" y1=\"5\" y2=\"5\"/></svg>",
        style_of(report, method));
}

std::vector<Plot> make_plots(const Report& report) {
    std::vector<Plot> plots;
    const std::vector<ComparedMethod>& methods = report.comparison.methods;
    std::vector<std::vector<MeasureSummary>> summaries;
    summaries.reserve(methods.size());
    for (const ComparedMethod& method : methods) {
        summaries.push_back(summarize_metrics(method.metrics));
    }
    for (const PlottedMeasure& measure : plotted) {
        Plot plot{std::string(measure.title), std::string(measure.unit), {}, {}};
        for (std::size_t m = 0; m < methods.size(); ++m) {
            for (const MeasureSummary& summary : summaries[m]) {
                if (summary.name != measure.name) continue;
                plot.lines.push_back({methods[m].name, style_of(report, m), summary.values});
            }
        }
        if (plot.lines.size() != methods.size() || methods.front().metrics.frames.empty()) continue;
        for (const FrameMetrics& frame : methods.front().metrics.frames) {
            plot.frames.push_back(frame.frame);
        }
        plots.push_back(std::move(plot));
    }
    return plots;
}

/// What the script reads. `<` must not end the element that holds it.
std::string script_data(const Report& report, const std::vector<Plot>& plots) {
    nlohmann::ordered_json data;
    data["methods"] = nlohmann::ordered_json::array();
    for (std::size_t m = 0; m < report.comparison.methods.size(); ++m) {
        data["methods"].push_back(
            {{"name", report.comparison.methods[m].name}, {"style", style_of(report, m)}});
    }
    data["frames"] = plots.empty() ? std::vector<int>() : plots.front().frames;
    data["plots"] = nlohmann::ordered_json::array();
    for (const Plot& plot : plots) {
        const Axis axis = axis_of(plot);
        nlohmann::ordered_json lines = nlohmann::ordered_json::array();
        for (const Plot::Line& line : plot.lines) lines.push_back(line.values);
        data["plots"].push_back({{"low", axis.low},
                                 {"high", axis.high},
                                 {"decimals", axis.decimals + 2},
                                 {"lines", std::move(lines)}});
    }
    std::string text = data.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;) {
        text.replace(at, 1, "\\u003c");
    }
    return text;
}

class Page {
public:
    explicit Page(const Report& report) : report_(report), plots_(make_plots(report)) {}

    std::string write() {
        begin();
        facts();
        measures();
        plots();
        pictures();
        table("Time of the stages",
              "Seconds. CPU time is that of all threads together; wall time is shorter where there "
              "are several.",
              report_.times, false);
        table("Options", "What each run was told; values in bold differ between the columns.",
              report_.options, true);
        defined();
        end();
        return std::move(text_);
    }

private:
    template <class... Values>
    void put(fmt::format_string<Values...> format, Values&&... values) {
        fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
    }

    const std::vector<ComparedMethod>& methods() const { return report_.comparison.methods; }

    void begin() {
        put("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
            "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
            "<meta name=\"color-scheme\" content=\"light dark\">\n<title>{}</title>\n"
            "<link rel=\"icon\" href=\"data:,\">\n<style>\n{}</style>\n</head>\n<body>\n<header>\n"
            "<h1>{}</h1>\n<p class=\"lead\">{}</p>\n",
            escape_html(report_.title), page_style, escape_html(report_.title),
            escape_html(report_.lead));
        if (methods().size() > 1) {
            text_ += "<ul class=\"methods\">\n";
            for (std::size_t m = 0; m < methods().size(); ++m) {
                put("<li><span>{}</span><span><b>{}</b> {}</span></li>\n", key_of(report_, m),
                    escape_html(methods()[m].name), escape_html(methods()[m].description));
            }
            text_ += "</ul>\n";
        }
        text_ += "</header>\n<main>\n";
    }

    void facts() {
        if (report_.facts.empty()) return;
        text_ += "<dl class=\"facts\">\n";
        for (const auto& [label, value] : report_.facts) {
            put("<div><dt>{}</dt><dd>{}</dd></div>\n", escape_html(label), escape_html(value));
        }
        text_ += "</dl>\n";
    }

    /// The best of a row in bold, where there is something to choose from.
    static std::vector<bool> best_of(const ComparisonRow& row) {
        std::vector<bool> is_best(row.values.size(), false);
        if (row.better == ComparisonRow::Better::neither) return is_best;
        const double sign = row.better == ComparisonRow::Better::lower ? 1 : -1;
        double best = std::numeric_limits<double>::infinity();
        std::size_t known = 0;
        for (const double value : row.values) {
            if (!std::isfinite(value)) continue;
            ++known;
            best = std::min(best, sign * value);
        }
        for (std::size_t i = 0; known > 1 && i < row.values.size(); ++i) {
            is_best[i] = sign * row.values[i] == best;
        }
        return is_best;
    }

    void measures() {
        text_ +=
            "<h2>Measures</h2>\n<div class=\"wide\" tabindex=\"0\" role=\"region\" "
            "aria-label=\"Measures\">\n<table>\n<thead><tr><th scope=\"col\"></th>";
        for (std::size_t m = 0; m < methods().size(); ++m) {
            put("<th scope=\"col\">{}{}</th>", key_of(report_, m), escape_html(methods()[m].name));
        }
        text_ += "</tr></thead>\n<tbody>\n";
        for (const ComparisonRow& row : comparison_rows(report_.comparison)) {
            const bool begins =
                row.label.ends_with(", mean") || row.key == "symmetry_error_degrees";
            put("<tr{}><th scope=\"row\">{}{}</th>", begins ? " class=\"group\"" : "", row.label,
                row.unit.empty() ? "" : fmt::format(" <span class=\"unit\">{}</span>", row.unit));
            const std::vector<bool> is_best = best_of(row);
            for (std::size_t m = 0; m < row.values.size(); ++m) {
                if (!std::isfinite(row.values[m])) {
                    text_ += "<td class=\"unknown\">–</td>";
                    continue;
                }
                put("<td{}>{:.{}f}</td>", is_best[m] ? " class=\"best\"" : "", row.values[m],
                    row.decimals);
            }
            text_ += "</tr>\n";
        }
        text_ += "</tbody>\n</table>\n</div>\n";
    }

    void plots() {
        if (plots_.empty()) return;
        text_ +=
            "<section>\n<h2>Frame by frame</h2>\n<div class=\"controls\">\n<ul class=\"legend\">\n";
        for (std::size_t m = 0; m < methods().size(); ++m) {
            put("<li><button type=\"button\" data-method=\"{}\" aria-pressed=\"true\">{}{}</button>"
                "</li>\n",
                m, key_of(report_, m), escape_html(methods()[m].name));
        }
        text_ += "</ul>\n";
        const std::size_t count = plots_.front().frames.size();
        if (count > 1) {
            put("<label class=\"scrub\"><span>Frame</span><input type=\"range\" min=\"0\" "
                "max=\"{}\" value=\"0\"><output></output></label>\n",
                count - 1);
        }
        text_ += "</div>\n<div class=\"plots\">\n";
        for (std::size_t i = 0; i < plots_.size(); ++i) {
            text_ += format_plot(plots_[i], static_cast<int>(i));
        }
        text_ += "</div>\n</section>\n";
    }

    void pictures() {
        if (report_.pictures.empty()) return;
        text_ +=
            "<section class=\"pictures\">\n<h2>Pictures</h2>\n<p class=\"note\">Edges of quads are "
            "drawn, their diagonals are not. Dots are singular vertices: red where fewer than four "
            "quads meet, blue where more.</p>\n";
        for (const ReportPictures& row : report_.pictures) {
            put("<h3>Frame {}</h3>\n<div class=\"strip\" tabindex=\"0\" role=\"region\" "
                "aria-label=\"Pictures of frame {}\">\n",
                row.frame, row.frame);
            for (const auto& [caption, image] : row.panels) {
                const std::string text = escape_html(caption);
                put("<figure class=\"picture\"><img alt=\"{}, frame {}\" width=\"{}\" "
                    "height=\"{}\" src=\"data:image/png;base64,{}\"><figcaption>{}</figcaption>"
                    "</figure>\n",
                    text, row.frame, image.width, image.height, encode_base64(encode_png(image)),
                    text);
            }
            text_ += "</div>\n";
        }
        text_ +=
            "<dialog aria-label=\"Enlarged picture\"><img alt=\"\"><form method=\"dialog\">"
            "<button type=\"button\" data-step=\"-1\" aria-label=\"Previous picture\">←</button>"
            "<output></output><button type=\"button\" data-step=\"1\" aria-label=\"Next "
            "picture\">→</button><button>Close</button></form></dialog>\n</section>\n";
    }

    void table(std::string_view title, std::string_view note, const ReportTable& table,
               bool mark_differences) {
        if (table.rows.empty()) return;
        put("<h2>{0}</h2>\n<p class=\"note\">{1}</p>\n<div class=\"wide\" tabindex=\"0\" "
            "role=\"region\" aria-label=\"{0}\">\n<table>\n<thead><tr><th scope=\"col\"></th>",
            title, table.columns.size() > 1 || !mark_differences ? note : "What the run was told.");
        for (const std::string& column : table.columns) {
            put("<th scope=\"col\">{}</th>", escape_html(column));
        }
        text_ += "</tr></thead>\n<tbody>\n";
        for (const ReportTable::Row& row : table.rows) {
            put("<tr><th scope=\"row\">{}</th>", escape_html(row.label));
            const bool differs =
                mark_differences &&
                std::any_of(row.cells.begin(), row.cells.end(),
                            [&](const std::string& cell) { return cell != row.cells.front(); });
            for (const std::string& cell : row.cells) {
                put("<td{}>{}</td>", differs ? " class=\"differs\"" : "", escape_html(cell));
            }
            text_ += "</tr>\n";
        }
        text_ += "</tbody>\n</table>\n</div>\n";
    }

    void defined() {
        text_ += "<h2>Definitions</h2>\n<dl class=\"definitions\">\n";
        for (const Definition& definition : definitions) {
            put("<dt>{}</dt><dd>{}</dd>\n", definition.term, definition.text);
        }
        text_ += "</dl>\n";
    }

    void end() {
        put("</main>\n<footer>{}</footer>\n<script type=\"application/json\" id=\"data\">{}"
            "</script>\n<script>\n{}</script>\n</body>\n</html>\n",
            escape_html(report_.footer), script_data(report_, plots_), page_script);
    }

    const Report& report_;
    std::vector<Plot> plots_;
    std::string text_;
};

}  // namespace

std::string format_report(const Report& report) { return Page(report).write(); }

}  // namespace kinequad
