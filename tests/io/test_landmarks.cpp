#include <gtest/gtest.h>

#include <random>
#include <string>

#include "io_support.h"
#include "kinequad/io/landmarks.h"
#include "support/data.h"

namespace kinequad::test {
namespace {

void expect_landmarks_fault(const std::string& text, InputFault fault,
                            const std::vector<std::string>& parts) {
    expect_input_error([&] { parse_landmarks(text, "marks.json"); }, fault, parts);
}

TEST(ReadLandmarks, ReadsPairsAndStationaryVertices) {
    const Landmarks both = parse_landmarks(
        R"({"pairs": [[4, 7], [0, 1]], "stationary": [9], "names": ["x"]})", "marks.json");
    EXPECT_EQ(both.pairs, (std::vector<std::array<int, 2>>{{4, 7}, {0, 1}}));
    EXPECT_EQ(both.stationary, std::vector<int>{9});
    EXPECT_EQ(both.name, "marks.json");
    EXPECT_TRUE(parse_landmarks(R"({"pairs": [[4, 7]]})", "marks.json").stationary.empty());
    const std::string line_alone = R"({"pairs": [], "stationary": [1, 2]})";
    EXPECT_EQ(parse_landmarks(line_alone, "marks.json").stationary.size(), 2U);
}

TEST(ReadLandmarks, RefusesWhatIsWrong) {
    expect_landmarks_fault("", InputFault::file, {"marks.json", "no valid JSON"});
    expect_landmarks_fault("{\"pairs\": [[1,\n2", InputFault::file, {"marks.json", "line 2"});
    expect_landmarks_fault("[1]", InputFault::file, {"marks.json", "pairs"});
    expect_landmarks_fault(R"({"pair": [[1, 2]], "stationary": [3]})", InputFault::file,
                           {"marks.json", "no \"pairs\""});
    expect_landmarks_fault(R"({"pairs": 3})", InputFault::file, {"\"pairs\"", "list"});
    expect_landmarks_fault(R"({"pairs": [[1, 2], [3]]})", InputFault::file, {"pairs[1]", "two"});
    expect_landmarks_fault(R"({"pairs": [[1, 2.5]]})", InputFault::file, {"pairs[0][1]"});
    expect_landmarks_fault(R"({"pairs": [], "stationary": ["a"]})", InputFault::file,
                           {"stationary[0]"});
    expect_landmarks_fault(R"({"pairs": [[1, -2]]})", InputFault::symmetry, {"pairs[0][1]", "-2"});
    expect_landmarks_fault(R"({"pairs": [[1, 18446744073709551615]]})", InputFault::symmetry,
                           {"pairs[0][1] is 18446744073709551615"});
    expect_landmarks_fault(R"({"pairs": [[4, 5], [1, 1]]})", InputFault::symmetry,
                           {"pairs[1]", "vertex 1 to itself", "stationary"});
    expect_landmarks_fault(R"({"pairs": [[1, 2]], "stationary": [2]})", InputFault::symmetry,
                           {"vertex 2", "pairs[0][1] and stationary[0]"});
    const std::string deep(100000, '[');
    expect_landmarks_fault(deep, InputFault::file, {"marks.json"});
    const Landmarks landmarks = parse_landmarks(R"({"pairs": [[4, 7]]})", "marks.json");
    EXPECT_NO_THROW(require_landmarks_fit(landmarks, 8));
    expect_input_error([&] { require_landmarks_fit(landmarks, 7); }, InputFault::symmetry,
                       {"marks.json", "pairs[0][1] is 7", "7 vertices"});
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

/// Random JSON of the kind that a landmarks file is, mostly nearly right.
std::string random_landmarks(std::mt19937_64& random) {
    const auto one_in = [&](unsigned n) { return random() % n == 0; };
    const auto number = [&]() -> std::string {
        switch (random() % 12) {
            case 0:
                return std::to_string(random());
            case 1:
                return std::string("-") + std::to_string(random() % 100);
            case 2:
                return std::string("1e") + std::to_string(random() % 400);
            case 3:
                return one_in(2) ? "null" : "\"7\"";
            default:
                return std::to_string(random() % 60);
        }
    };
    const auto list = [&](std::size_t most, const auto& item) {
        std::string text = "[";
        const std::size_t count = random() % (most + 1);
        for (std::size_t i = 0; i < count; ++i) text += std::string(i > 0 ? ", " : "") + item();
        return text + (one_in(40) ? "" : "]");
    };
    const auto pair = [&] {
        return one_in(9) ? list(4, number) : std::string("[") + number() + "," + number() + "]";
    };
    std::string text = "{";
    if (!one_in(6)) text += std::string("\"pairs\": ") + (one_in(12) ? number() : list(6, pair));
    if (!one_in(4))
        text += (one_in(20) ? " " : ", ") + std::string("\"stationary\": ") + list(4, number);
    text += one_in(30) ? "" : "}";
    if (one_in(10)) text[random() % text.size()] = static_cast<char>(random() % 256);
    if (one_in(10)) text.resize(random() % text.size());
    return text;
}

TEST(ReadLandmarks, TenThousandRandomFilesAreUnderstoodOrRefused) {
    std::mt19937_64 random(11);
    int understood = 0;
    for (int round = 0; round < 10'000; ++round) {
        const std::string text = random_landmarks(random);
        try {
            const Landmarks landmarks = parse_landmarks(text, "marks.json");
            require_landmarks_fit(landmarks, 60);
            ++understood;
            for (const auto& [a, b] : landmarks.pairs) {
                ASSERT_TRUE(0 <= a && a < 60 && 0 <= b && b < 60 && a != b) << text;
            }
            for (const int v : landmarks.stationary) ASSERT_TRUE(0 <= v && v < 60) << text;
        } catch (const InputError& error) {
            ASSERT_EQ(std::string(error.what()).rfind("marks.json", 0), 0U) << error.what();
            ASSERT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        }
    }
    EXPECT_GT(understood, 500);
    EXPECT_LT(understood, 9'500);
}

}  // namespace
}  // namespace kinequad::test
