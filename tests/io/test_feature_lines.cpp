#include <gtest/gtest.h>

#include <string>

#include "kinequad/core/error.h"
#include "kinequad/io/feature_lines.h"

namespace kinequad {
namespace {

TEST(FeatureLines, ChainsBecomePairs) {
    const FeatureLines lines =
        parse_feature_lines(R"({"lines": [[0, 1, 2], [7, 5]], "by": "hand"})", "f");
    EXPECT_EQ(lines, (FeatureLines{{0, 1}, {1, 2}, {7, 5}}));
}

TEST(FeatureLines, WhatIsWrongIsNamed) {
    const auto message = [](const std::string& text) -> std::string {
        try {
            parse_feature_lines(text, "f.json");
        } catch (const InputError& error) {
            return error.what();
        }
        return "none";
    };
    EXPECT_EQ(message("{"), "f.json: is no valid JSON");
    EXPECT_EQ(message("[]"), R"(f.json: has to hold {"lines": [[i, j, ...], ...]})");
    EXPECT_EQ(message(R"({"lines": [[0, 1], [3]]})"),
              "f.json: lines[1] has to be a list of two vertices or more");
    EXPECT_EQ(message(R"({"lines": [[0, -1]]})"),
              "f.json: lines[0][1] is no vertex; write a whole number from 0");
    EXPECT_EQ(message(R"({"lines": [[0, 99999999999]]})"),
              "f.json: lines[0][1] is no vertex; write a whole number from 0");
}

}  // namespace
}  // namespace kinequad
