#pragma once

#include <string>
#include <utility>
#include <vector>

#include "kinequad/measure/comparison.h"
#include "kinequad/report/image.h"

namespace kinequad {

/// A value with its name.
using ReportFact = std::pair<std::string, std::string>;

/// A table with a column for some of the methods: their options, or the times of their stages.
struct ReportTable {
    struct Row {
        std::string label;
        std::vector<std::string> cells;  ///< one a column
    };
    std::vector<std::string> columns;
    std::vector<Row> rows;
};

/// Pictures of one frame, one a method.
struct ReportPictures {
    int frame = 0;
    std::vector<std::pair<std::string, Image>> panels;  ///< with what the picture shows
};

/// What a report is made of.
struct Report {
    std::string title;
    std::string lead;  ///< a sentence or two below the title
    std::vector<ReportFact> facts;
    Comparison comparison;  ///< at least one method
    int highlighted = -1;   ///< the method that is drawn in the strong colour; -1 for none
    std::vector<ReportPictures> pictures;
    ReportTable times;  ///< seconds of the stages
    ReportTable options;
    std::string footer;  ///< program and version
};

/// report.html: one file that needs no other and no network. Table of the measures, plots against
/// the frame, pictures, times and options. Complete without scripts; the small one in it adds a
/// cursor through the frames and hides lines. Text from the input is escaped. docs/report.md
std::string format_report(const Report& report);

}  // namespace kinequad
