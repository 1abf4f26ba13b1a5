#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "run_program.h"

namespace kinequad {
namespace {

using test::content_of;
using test::Outcome;
using test::run_program;
using test::ScratchFolder;

TEST(CompareProgram, LeavesTableFramesAndReport) {
    const ScratchFolder scratch;
    make_biped(scratch);
    ASSERT_EQ(run_program(scratch,
                          "run biped -o mine --vertices 700 --no-metrics --reference rest "
                          "--no-report --format obj -q")
                  .code,
              0);
    ASSERT_FALSE(std::filesystem::exists(scratch / "mine" / "report.html"));
    ASSERT_EQ(run_program(scratch, "convert mine/quads pose.obj --frame 0 -q").code, 0);
    const Outcome outcome =
        run_program(scratch,
                    "compare biped -o out --vertices 600 --also \"my mesh!=pose.obj\" "
                    "--pictures 1 --quads -q");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    const auto json = nlohmann::json::parse(content_of(scratch / "out" / "compare.json"));
    ASSERT_EQ(json["methods"].size(), 5U);
    EXPECT_EQ(json["frames"].size(), 4U);
    for (const auto& method : json["methods"]) {
        EXPECT_EQ(method["hausdorff_percent"].size(), 4U);
        EXPECT_NE(outcome.out.find(method["name"].get<std::string>()), std::string::npos);
        // The rest shape mirrors in a plane, which is found without landmarks.
        EXPECT_TRUE(method["symmetry_error_degrees"].is_number());
    }
    EXPECT_TRUE(json["methods"][4]["cpu_seconds"].is_null());
    EXPECT_TRUE(std::filesystem::exists(scratch / "out" / "quads" / "2-animation-only.pc2"));
    EXPECT_TRUE(std::filesystem::exists(scratch / "out" / "quads" / "5-my-mesh.obj"));
    const std::string csv = content_of(scratch / "out" / "compare.csv");
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 6);
    const std::string frames = content_of(scratch / "out" / "frames.csv");
    EXPECT_EQ(std::count(frames.begin(), frames.end(), '\n'), 21);
    const std::string page = content_of(scratch / "out" / "report.html");
    EXPECT_NE(page.find("Frame 1<"), std::string::npos);
    EXPECT_EQ(page.find("Frame 0<"), std::string::npos);
}

TEST(CompareProgram, RefusesWhatItCannotCompare) {
    const ScratchFolder scratch;
    make_biped(scratch);
    for (const auto& [arguments, code, part] : {std::tuple{"--also nothing", 2, "NAME=FILE"},
                                                {"--also a=absent.obj", 3, "absent.obj"},
                                                {"--pictures 4", 2, "frame 4"},
                                                {"--also paper=biped/biped.obj", 2, "'paper'"},
                                                {"--landmarks absent.json", 3, "absent.json"},
                                                {"--vertices 3", 2, "--vertices"}}) {
        const Outcome outcome =
            run_program(scratch, std::string("compare biped -o out -q ") + arguments);
        EXPECT_EQ(outcome.code, code) << arguments << ": " << outcome.err;
        EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
        EXPECT_FALSE(std::filesystem::exists(scratch / "out")) << arguments;
    }
}

TEST(CompareProgram, AnInterruptedComparisonLeavesNothing) {
    const ScratchFolder scratch;
    make_biped(scratch);
    test::write_content(scratch / "interrupt.sh",
                        "timeout --preserve-status --signal=INT 0.5 \"$@\"\nexit $?\n");
    const std::string program = KINEQUAD_PROGRAM;
    const Outcome outcome = run_program(scratch, "--version; sh interrupt.sh " + program +
                                                     " compare biped --vertices 60000 -o out -q");
    EXPECT_EQ(outcome.code, 130) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(scratch / "out"));
}

TEST(RenderProgram, WritesThePicturesOfAFilm) {
    const ScratchFolder scratch;
    make_biped(scratch);
    const auto names = [&](const char* folder) {
        std::vector<std::string> found;
        for (const auto& entry : std::filesystem::directory_iterator(scratch / folder)) {
            found.push_back(entry.path().filename().string());
        }
        std::sort(found.begin(), found.end());
        return found;
    };
    ASSERT_EQ(run_program(scratch, "render biped -o turn --turntable 3 --size 64,48 -q").code, 0);
    EXPECT_EQ(names("turn"), (std::vector<std::string>{"picture_0000.png", "picture_0001.png",
                                                       "picture_0002.png"}));
    EXPECT_NE(content_of(scratch / "turn" / "picture_0000.png"),
              content_of(scratch / "turn" / "picture_0001.png"));
    const std::string film = "render biped biped -o film --animation --frame-step 2 --size 64,48";
    ASSERT_EQ(run_program(scratch, film + " -q").code, 0);
    EXPECT_EQ(names("film"), (std::vector<std::string>{"picture_0000.png", "picture_0001.png"}));
    for (const char* wrong :
         {"render biped -o film.png --animation", "render biped -o film",
          "render biped -o turn --turntable 2 --animation", "render biped -o turn --turntable 0"}) {
        EXPECT_EQ(run_program(scratch, std::string(wrong) + " -q").code, 2) << wrong;
    }
}

}  // namespace
}  // namespace kinequad
