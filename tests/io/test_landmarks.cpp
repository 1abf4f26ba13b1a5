#include <gtest/gtest.h>

#include "io_support.h"
#include "kinequad/io/landmarks.h"
#include "support/data.h"

namespace kinequad::test {
namespace {

void expect_fault(const std::string& text, InputFault fault,
                  const std::vector<std::string>& parts) {
    expect_input_error([&] { parse_landmarks(text, "marks.json"); }, fault, parts);
}

TEST(ReadLandmarks, ReadsPairsAndStationaryVertices) {
    const Landmarks both = parse_landmarks(
        R"({"pairs": [[4, 7], [0, 1]], "stationary": [9], "names": ["x"]})", "marks.json");
    EXPECT_EQ(both.pairs, (std::vector<std::array<int, 2>>{{4, 7}, {0, 1}}));
    EXPECT_EQ(both.stationary, std::vector<int>{9});
    EXPECT_TRUE(parse_landmarks("{}", "marks.json").pairs.empty());
    EXPECT_EQ(parse_landmarks(R"({"stationary": [1, 2]})", "marks.json").stationary.size(), 2U);
}

TEST(ReadLandmarks, RefusesWhatIsWrong) {
    expect_fault("", InputFault::file, {"marks.json", "no valid JSON"});
    expect_fault("{\"pairs\": [[1,\n2", InputFault::file, {"marks.json", "line 2"});
    expect_fault("[1]", InputFault::file, {"marks.json", "pairs"});
    expect_fault(R"({"pairs": 3})", InputFault::file, {"\"pairs\"", "list"});
    expect_fault(R"({"pairs": [[1, 2], [3]]})", InputFault::file, {"pairs[1]", "two"});
    expect_fault(R"({"pairs": [[1, 2.5]]})", InputFault::file, {"pairs[0][1]"});
    expect_fault(R"({"stationary": ["a"]})", InputFault::file, {"stationary[0]"});
    expect_fault(R"({"pairs": [[1, -2]]})", InputFault::symmetry, {"pairs[0][1]", "-2"});
    expect_fault(R"({"pairs": [[1, 18446744073709551615]]})", InputFault::symmetry,
                 {"pairs[0][1]"});
    expect_fault(R"({"pairs": [[1, 1]]})", InputFault::symmetry, {"vertex 1", "twice"});
    expect_fault(R"({"pairs": [[1, 2]], "stationary": [2]})", InputFault::symmetry, {"vertex 2"});
    const std::string deep(100000, '[');
    expect_fault(deep, InputFault::file, {"marks.json"});
    const Landmarks landmarks = parse_landmarks(R"({"pairs": [[4, 7]]})", "marks.json");
    EXPECT_NO_THROW(require_landmarks_fit(landmarks, 8, "marks.json"));
    expect_input_error([&] { require_landmarks_fit(landmarks, 7, "marks.json"); },
                       InputFault::symmetry, {"marks.json", "vertex 7", "7 vertices"});
}

TEST(ReadLandmarks, ReadsThoseOfTheRealSequences) {
    KINEQUAD_REQUIRE_DATA();
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(data_folder() / "landmarks")) {
        EXPECT_GE(read_landmarks(entry.path()).pairs.size(), 3U) << entry.path();
        ++count;
    }
    EXPECT_GE(count, 10);
}

}  // namespace
}  // namespace kinequad::test
