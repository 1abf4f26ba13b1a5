#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "kinequad/io/open_sequence.h"
#include "kinequad/mesh/triangle_mesh.h"
#include "run_program.h"

namespace kinequad {
namespace {

using test::content_of;
using test::Outcome;
using test::run_program;
using test::ScratchFolder;
using test::write_content;

/// Expects one line of error that holds `part`, nothing on stdout, and no folder `out`.
void expect_refused(const ScratchFolder& scratch, const std::string& arguments, int code,
                    const std::string& part) {
    SCOPED_TRACE(arguments);
    const Outcome outcome = run_program(scratch, arguments);
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err.rfind("kinequad: error: ", 0), 0U) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(scratch / "out"));
}

/// Makes the sequence `biped` in the scratch folder: a small creature in a few frames.
std::vector<std::string> names_in(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

TEST(Program, ExplainsItself) {
    const ScratchFolder scratch;
    for (const char* arguments :
         {"--help", "run --help", "compare --help", "measure --help", "synth --help",
          "render --help", "convert --help", "symmetry --help"}) {
        const Outcome outcome = run_program(scratch, arguments);
        EXPECT_EQ(outcome.code, 0) << arguments;
        EXPECT_NE(outcome.out.find("--help"), std::string::npos) << arguments;
        EXPECT_EQ(outcome.err, "") << arguments;
    }
    EXPECT_EQ(run_program(scratch, "--version").out.rfind("kinequad ", 0), 0U);
}

TEST(Program, AnswersWrongUsageWithCode2) {
    const ScratchFolder scratch;
    write_content(scratch / "one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    expect_refused(scratch, "", 2, "subcommand");
    expect_refused(scratch, "fly", 2, "--help");
    expect_refused(scratch, "run -o out", 2, "INPUT");
    expect_refused(scratch, "run one.obj", 2, "--output");
    expect_refused(scratch, "run one.obj -o out --vertices many", 2, "--vertices");
    expect_refused(scratch, "run one.obj -o out --alpha 1.5 -q", 2, "--alpha");
    expect_refused(scratch, "run one.obj -o out --reference 1 -q", 2, "--reference 1");
    expect_refused(scratch, "run one.obj -o out --reference rest -q", 2, "no rest shape");
    expect_refused(scratch, "synth unicorn -o out", 2, "unicorn");
}

TEST(Program, AnswersFilesItCannotReadWithCode3) {
    const ScratchFolder scratch;
    expect_refused(scratch, "run absent.obj -o out -q", 3, "absent.obj");
    write_content(scratch / "bad.obj", "v 0 0 zero\n");
    expect_refused(scratch, "run bad.obj -o out -q", 3, "bad.obj");
}

TEST(Program, AnswersFoldersItCannotMakeWithCode3) {
    const ScratchFolder scratch;
    write_content(scratch / "one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write_content(scratch / "file", "");
    expect_refused(scratch, "run one.obj -o file/below -q", 3, "file/below");
}

TEST(Program, AnswersInvalidMeshesWithCode4) {
    const ScratchFolder scratch;
    write_content(scratch / "tie.obj",
                  "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nf 1 2 3\nf 1 4 5\n");
    expect_refused(scratch, "run tie.obj -o out -q", 4, "tie.obj: 1 non-manifold vertex: 0");
    write_content(scratch / "flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    expect_refused(scratch, "run flat.obj -o out -q", 4, "has no area");
}

TEST(Program, LeavesTheFolderAsItWasWhereItFails) {
    const ScratchFolder scratch;
    write_content(scratch / "tie.obj",
                  "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nf 1 2 3\nf 1 4 5\n");
    std::filesystem::create_directory(scratch / "kept");
    write_content(scratch / "kept" / "quads.obj", "mine");
    EXPECT_EQ(run_program(scratch, "run tie.obj -o kept -q").code, 4);
    EXPECT_EQ(names_in(scratch / "kept"), std::vector<std::string>{"quads.obj"});
    EXPECT_EQ(content_of(scratch / "kept" / "quads.obj"), "mine");
}

TEST(Program, AnInterruptedRunEndsWithCode130AndLeavesNothing) {
    const ScratchFolder scratch;
    // `timeout` sends SIGINT once the run is on its way; a run of this size takes far longer.
    write_content(scratch / "interrupt.sh",
                  "timeout --preserve-status --signal=INT 0.5 \"$@\"\nexit $?\n");
    const std::string program = KINEQUAD_PROGRAM;
    const Outcome outcome =
        run_program(scratch, "--version; sh interrupt.sh " + program +
                                 " synth biped --triangles 4000000 --frames 1000 -o out -q");
    EXPECT_EQ(outcome.code, 130) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(scratch / "out"));
}

TEST(Program, ConvertsThereAndBackWithoutLoss) {
    const ScratchFolder scratch;
    make_biped(scratch);
    EXPECT_EQ(run_program(scratch, "convert biped frames -q").code, 0);
    EXPECT_EQ(run_program(scratch, "convert frames back.pc2 -q").code, 0);
    EXPECT_EQ(content_of(scratch / "back.pc2"), content_of(scratch / "biped" / "biped.pc2"));
    EXPECT_EQ(run_program(scratch, "convert biped other.mdd -q").code, 0);
    EXPECT_EQ(run_program(scratch, "convert other.obj again.pc2 -q").code, 0);
    EXPECT_EQ(content_of(scratch / "again.pc2"), content_of(scratch / "back.pc2"));
    EXPECT_EQ(run_program(scratch, "convert biped one.obj --frame 2 -q").code, 0);
    EXPECT_EQ(content_of(scratch / "one.obj"), content_of(scratch / "frames" / "frames_0002.obj"));
    expect_refused(scratch, "convert biped many.obj -q", 2, "--frame");
}

TEST(Program, NamesFramesByTheFolderHoweverItIsGiven) {
    const ScratchFolder scratch;
    write_content(scratch / "one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const std::filesystem::path walk = scratch / "walk";
    for (const char* here : {".", "./", "../walk", "../walk/.", "inner/.."}) {
        SCOPED_TRACE(here);
        std::filesystem::create_directories(walk / "inner");
        const Outcome outcome = run_program(
            scratch,
            std::string("--version >.log; cd walk && " KINEQUAD_PROGRAM " convert ../one.obj -q ") +
                here);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(names_in(walk), (std::vector<std::string>{"inner", "walk_0000.obj"}));
        std::filesystem::remove_all(walk);
    }
}

TEST(Program, WritesTheTrueMirrorOfACreature) {
    const ScratchFolder scratch;
    make_biped(scratch);
    const auto mirror =
        nlohmann::json::parse(content_of(scratch / "biped" / "mirror.json"))["mirror"]
            .get<std::vector<std::size_t>>();
    for (std::size_t v = 0; v < mirror.size(); ++v) EXPECT_EQ(mirror.at(mirror[v]), v);
}

TEST(Program, RendersAPicture) {
    const ScratchFolder scratch;
    make_biped(scratch);
    EXPECT_EQ(run_program(scratch, "render biped -o picture.png --frame 0,3 --size 64,32 -q").code,
              0);
    EXPECT_EQ(content_of(scratch / "picture.png").substr(1, 3), "PNG");
    expect_refused(scratch, "render biped -o other.png --frame 4 -q", 2, "--frame 4");
}

TEST(Program, RefusesToDrawFilesOfOtherSurfaces) {
    const ScratchFolder scratch;
    write_content(scratch / "one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const std::string image = R"("image": [[0, 1, 0, 0], [0, 0, 1, 0], [-1, 1, 0, 0]])";
    const auto expect = [&](const std::string& option, const std::string& content, int code) {
        SCOPED_TRACE(content);
        write_content(scratch / "in.json", content);
        expect_refused(scratch, "render one.obj -o out.png --size 32,32 -q " + option + " in.json",
                       code, "in.json");
    };
    const std::string draw = "render one.obj -o out.png --size 32,32 -q ";
    write_content(scratch / "fit.json", "{" + image + R"(, "stationary": [[[0, 0.5, 0.5, 0]]]})");
    EXPECT_EQ(run_program(scratch, draw + "--symmetry fit.json").code, 0);
    write_content(scratch / "field.json", R"({"streamlines": [[[0, 0.5, 0.5, 0]], []]})");
    EXPECT_EQ(run_program(scratch, draw + "--field field.json").code, 0);

    // A triangle that there is not: after the last, far after, before the first, no number.
    for (const auto& [triangle, code] :
         std::vector<std::pair<std::string, int>>{{"1", 4},
                                                  {"99999999999", 4},
                                                  {"18446744073709551615", 4},
                                                  {"-1", 4},
                                                  {"-7", 4},
                                                  {"\"0\"", 3},
                                                  {"0.5", 3},
                                                  {"null", 3}}) {
        const std::string lines = "[[[" + triangle + ", 0.5, 0.5, 0]]]";
        expect("--symmetry", "{" + image + ", \"stationary\": " + lines + "}", code);
        expect("--field", "{\"streamlines\": " + lines + "}", code);
        // An image of -1 is none.
        if (triangle == "-1") continue;
        expect("--symmetry",
               "{\"image\": [[" + triangle +
                   ", 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], \"stationary\": []}",
               code);
    }
    for (const char* lines :
         {"7", "[7]", "[[7]]", "[[[0]]]", "[[[0, 1, 0]]]", "[[[0, 0.5, 0.5, \"0\"]]]",
          "[[[0, 1, 0, 0, 0]]]", "[[[0, 3, -1, -1]]]", "[[[0, 1e300, 0, 0]]]", "[[{}]]", "null"}) {
        expect("--symmetry", "{" + image + ", \"stationary\": " + lines + "}", 3);
        expect("--field", std::string("{\"streamlines\": ") + lines + "}", 3);
    }
    expect("--symmetry", R"({"image": [], "stationary": []})", 4);
    expect("--symmetry", "[]", 4);
    expect("--field", "{", 3);
}

TEST(Program, RefusesToDrawAMirrorOfOtherQuads) {
    const ScratchFolder scratch;
    write_content(scratch / "two.obj",
                  "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv -1 0 0\nv -1 1 0\n"
                  "f 1 2 3 4\nf 5 1 4 6\n");
    const std::string draw = "render two.obj --size 32,32 -q --mirror in.json -o ";
    write_content(scratch / "in.json", R"({"mirror": [0, 4, 5, 3, 1, 2]})");
    EXPECT_EQ(run_program(scratch, draw + "out.png").code, 0);
    for (const auto& [mirror, code] :
         std::vector<std::pair<std::string, int>>{{"[0, 4, 5, 3, 1, 6]", 4},
                                                  {"[0, 4, 5, 3, 1, -1]", 4},
                                                  {"[0, 4, 5, 3, 1]", 4},
                                                  {"[0, 4, 5, 3, 1, \"2\"]", 3},
                                                  {"[0, 4, 5, 3, 1, 2.5]", 3},
                                                  {"6", 3}}) {
        write_content(scratch / "in.json", "{\"mirror\": " + mirror + "}");
        expect_refused(scratch, draw + "other.png", code, "in.json");
    }
}

TEST(Program, RunLeavesTheSequenceItsRecordAndTheBinding) {
    const ScratchFolder scratch;
    make_biped(scratch);
    const Outcome outcome = run_program(scratch, "run biped -o out --vertices 800 --json");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(names_in(scratch / "out"),
              (std::vector<std::string>{"binding.json", "quads.obj", "quads.pc2", "report.html",
                                        "run.json"}));
    EXPECT_EQ(outcome.out, content_of(scratch / "out" / "run.json"));
    const auto record = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(record["input"]["frames"], 4);
    EXPECT_EQ(record["map"]["flipped_triangles"], 0);
    EXPECT_NEAR(record["quads"]["vertices"].get<int>(), 800, 40);
    // A closed surface of genus 0 in quads has two vertices more than quads.
    EXPECT_EQ(record["quads"]["vertices"].get<int>(), record["quads"]["quads"].get<int>() + 2);
    EXPECT_EQ(record["field"]["index_sum_in_quarters"], 8);

    // The metrics of the run are those that measuring its files gives, up to 32-bit coordinates.
    const Outcome measured = run_program(scratch, "measure out --against biped --json -q");
    ASSERT_EQ(measured.code, 0) << measured.err;
    const auto again = nlohmann::json::parse(measured.out);
    for (const char* name : {"angle_deviation_mean", "hausdorff_percent"}) {
        EXPECT_NEAR(again["mean"][name].get<double>(),
                    record["metrics"]["mean"][name].get<double>(), 0.01)
            << name;
    }
}

TEST(Program, RunWritesOtherFormatsOverEarlierOnes) {
    const ScratchFolder scratch;
    make_biped(scratch);
    const std::string run = "run biped -o out --vertices 500 --no-metrics -q";
    ASSERT_EQ(run_program(scratch, run).code, 0);
    ASSERT_EQ(run_program(scratch, run + " --format obj").code, 0);
    EXPECT_EQ(names_in(scratch / "out"),
              (std::vector<std::string>{"binding.json", "quads", "report.html", "run.json"}));
    EXPECT_EQ(names_in(scratch / "out" / "quads").size(), 4U);
}

TEST(Program, SingleMeshGivesASingleMesh) {
    const ScratchFolder scratch;
    make_biped(scratch);
    ASSERT_EQ(run_program(scratch, "convert biped one.obj --frame 0 -q").code, 0);
    ASSERT_EQ(run_program(scratch, "run one.obj -o out --vertices 500 --no-metrics -q").code, 0);
    EXPECT_EQ(names_in(scratch / "out"),
              (std::vector<std::string>{"binding.json", "quads.obj", "report.html", "run.json"}));
}

TEST(Program, ResultsDoNotDependOnTheNumberOfThreads) {
    const ScratchFolder scratch;
    make_biped(scratch);
    for (const char* threads : {"1", "2", "8"}) {
        const Outcome outcome =
            run_program(scratch, std::string("run biped --vertices 800 --no-metrics -q -o out") +
                                     threads + " --threads " + threads);
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        for (const char* name : {"quads.obj", "quads.pc2", "binding.json"}) {
            EXPECT_TRUE(content_of(scratch / (std::string("out") + threads) / name) ==
                        content_of(scratch / "out1" / name))
                << name << " differs with " << threads << " threads";
        }
    }
}

TEST(Program, FindsTheSymmetryOfACreatureWithoutAndWithLandmarks) {
    const ScratchFolder scratch;
    make_biped(scratch);
    const auto truth =
        nlohmann::json::parse(content_of(scratch / "biped" / "mirror.json"))["mirror"];
    const TriangleMesh creature = [&] {
        const std::unique_ptr<FrameSource> source = open_sequence((scratch / "biped").string());
        return TriangleMesh{source->read_rest_shape(), source->triangles()};
    }();
    const double diagonal = bounding_box_diagonal(creature.V);
    for (const char* landmarks : {"", " --landmarks biped/landmarks.json"}) {
        SCOPED_TRACE(landmarks);
        const Outcome outcome =
            run_program(scratch, std::string("symmetry biped -o map.json -q") + landmarks);
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        const auto map = nlohmann::json::parse(content_of(scratch / "map.json"));
        ASSERT_EQ(map["image"].size(), truth.size());
        double sum = 0;
        for (std::size_t v = 0; v < truth.size(); ++v) {
            const auto& image = map["image"][v];
            const SurfacePoint point{image[0], Vector3(image[1], image[2], image[3])};
            sum += (position_of(point, creature.V, creature.F) -
                    creature.V.row(truth[v].get<int>()).transpose())
                       .norm();
        }
        EXPECT_LT(sum / static_cast<double>(truth.size()), 0.003 * diagonal);
        EXPECT_EQ(map["stationary"].size(), 1U);
    }
}

TEST(Program, AnswersLandmarksThatDoNotFitWithCode5) {
    const ScratchFolder scratch;
    make_biped(scratch);
    const auto good = nlohmann::json::parse(content_of(scratch / "biped" / "landmarks.json"));
    const auto expect_refused = [&](const nlohmann::json& landmarks, const std::string& part) {
        write_content(scratch / "marks.json", landmarks.dump());
        const Outcome outcome =
            run_program(scratch, "symmetry biped --landmarks marks.json -o map.json -q");
        EXPECT_EQ(outcome.code, 5) << outcome.err;
        EXPECT_NE(outcome.err.find("marks.json: "), std::string::npos) << outcome.err;
        EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
        EXPECT_FALSE(std::filesystem::exists(scratch / "map.json"));
    };
    auto twice = good;
    twice["pairs"].push_back(good["pairs"][0]);
    expect_refused(twice, "is named twice, as pairs[0][0] and");
    auto beyond = good;
    beyond["pairs"][1][1] = 1'000'000;
    expect_refused(beyond, "pairs[1][1] is 1000000");
    auto exchanged = good;
    std::swap(exchanged["pairs"][0][1], exchanged["pairs"][good["pairs"].size() - 1][1]);
    expect_refused(exchanged, "disagree");
    auto few = good;
    few["pairs"] = nlohmann::json::array({good["pairs"][0]});
    few["stationary"] = nlohmann::json::array();
    expect_refused(few, "1 pair and 0 stationary vertices");
}

TEST(Program, DumpsWhatEveryStageMade) {
    const ScratchFolder scratch;
    make_biped(scratch);
    const int vertices = static_cast<int>(
        nlohmann::json::parse(content_of(scratch / "biped" / "mirror.json"))["mirror"].size());
    for (const std::string mode : {"none", "field", "exact"}) {
        SCOPED_TRACE(mode);
        const Outcome outcome = run_program(
            scratch, "run biped --landmarks biped/landmarks.json --symmetry " + mode +
                         " --vertices 800 --no-metrics --no-report -q -o out --dump-stages " +
                         mode);
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        const auto stage = [&](const char* name) {
            return nlohmann::json::parse(
                content_of(scratch / mode / (std::string(name) + ".json")));
        };
        const auto triangles = stage("check")["twin"].size() / 3;
        EXPECT_EQ(stage("check")["vertex_half_edge"].size(), vertices);
        EXPECT_GT(stage("metric")["edge_length"].size(), 0U);
        // Field, deformation of the last recipe and map are over one triangulation.
        const auto crosses = stage("field")["angle"].size();
        const auto map = stage("map");
        for (const auto& parent : map["parent"]) ASSERT_LT(parent.get<std::size_t>(), crosses);
        if (mode == "none") {
            EXPECT_EQ(crosses, triangles);
            EXPECT_EQ(stage("deformation")["stretch_sum"].size(), triangles);
        } else {
            EXPECT_EQ(stage("symmetry")["image"].size(), vertices);
            if (mode == "exact") {
                EXPECT_LT(crosses, triangles);
            }
        }
        const auto extracted = stage("extraction");
        const auto relaxed = stage("relaxation");
        EXPECT_GT(extracted["quads"].size(), 300U);
        for (const auto& point : extracted["vertex"]) ASSERT_LT(point[0].get<int>(), triangles);
        const std::size_t sides = mode == "exact" ? 2 : 1;
        EXPECT_EQ(relaxed["quads"].size(), sides * extracted["quads"].size());
    }
}

TEST(Program, ChecksAndRepairsMeshes) {
    const ScratchFolder scratch;
    // A square of four triangles around vertex 5, one turned over, one repeated.
    write_content(scratch / "bad.obj",
                  "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .5 .5 0\nv 9 9 9\n"
                  "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 1 4 5\nf 2 3 5\n");
    const Outcome checked = run_program(scratch, "run bad.obj --check");
    EXPECT_EQ(checked.code, 4);
    for (const char* part : {"1-4", "0-4", "3-4", "vertex without triangles: 5", "not valid"}) {
        EXPECT_NE(checked.out.find(part), std::string::npos) << checked.out;
    }
    const Outcome json = run_program(scratch, "run bad.obj --check --json");
    EXPECT_EQ(json.code, 4);
    const auto record = nlohmann::json::parse(json.out);
    EXPECT_EQ(record.at("refused").at("duplicate_triangles"), nlohmann::json({{1, 4}}));
    expect_refused(scratch, "run bad.obj -o out", 4, "bad.obj: 1 triangle repeats");
    const Outcome repaired = run_program(scratch, "run bad.obj --repair --check");
    EXPECT_EQ(repaired.code, 0) << repaired.err;
    EXPECT_NE(repaired.err.find("turned triangles over: 3"), std::string::npos) << repaired.err;
    const Outcome made =
        run_program(scratch, "run bad.obj --repair -o out --vertices 100 --no-metrics -q");
    EXPECT_EQ(made.code, 0) << made.err;
    const auto run = nlohmann::json::parse(content_of(scratch / "out/run.json"));
    const auto actions = run.at("input").at("repaired");
    ASSERT_EQ(actions.size(), 3U);
    EXPECT_EQ(actions[0], "passed over vertices without triangles: 5");
}

TEST(Program, LeavesNothingOfARunOnADamagedFile) {
    const ScratchFolder scratch;
    const std::string sound = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
    std::mt19937 random(3);
    int refused = 0;
    for (int round = 0; round < 30; ++round) {
        std::string damaged =
            sound.substr(0, round < 10 ? 4 * static_cast<std::size_t>(round) : sound.size());
        if (round >= 10) {
            damaged[random() % damaged.size()] = static_cast<char>(random() % 128);
            damaged[random() % damaged.size()] = "0123456789- vf\n"[random() % 15];
        }
        write_content(scratch / "in.obj", damaged);
        std::filesystem::remove_all(scratch / "out");
        const Outcome outcome =
            run_program(scratch, "run in.obj -o out --vertices 30 --no-metrics -q");
        EXPECT_EQ(std::filesystem::exists(scratch / "out"), outcome.code == 0) << damaged;
        EXPECT_TRUE(outcome.code == 0 || outcome.code == 3 || outcome.code == 4)
            << outcome.code << outcome.err << damaged;
        refused += outcome.code == 0 ? 0 : 1;
    }
    EXPECT_GT(refused, 10);
}

}  // namespace
}  // namespace kinequad
