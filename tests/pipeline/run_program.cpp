#include "run_program.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <system_error>

namespace kinequad::test {

ScratchFolder::ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "kinequad-test-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no folder " + name);
    path_ = name;
}

ScratchFolder::~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

Outcome run_program(const ScratchFolder& scratch, const std::string& arguments) {
    const std::filesystem::path out = scratch / ".out";
    const std::filesystem::path err = scratch / ".err";
    const std::string command = "cd " + scratch.path().string() + " && " KINEQUAD_PROGRAM " " +
                                arguments + " >" + out.string() + " 2>" + err.string();
    const int status = std::system(command.c_str());
    Outcome outcome;
    outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    outcome.out = content_of(out);
    outcome.err = content_of(err);
    return outcome;
}

void make_biped(const ScratchFolder& scratch) {
    namespace fs = std::filesystem;
    // Made once for every build of the program, beside it; a folder comes into place whole.
    const fs::path program = KINEQUAD_PROGRAM;
    const auto built = fs::last_write_time(program).time_since_epoch().count();
    const fs::path kept = program.parent_path() / ("test_biped_" + std::to_string(built));
    if (!fs::exists(kept)) {
        const Outcome outcome =
            run_program(scratch, "synth biped -o biped --triangles 3000 --frames 4 -q");
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        const fs::path fresh = kept.string() + "_" + scratch.path().filename().string();
        fs::copy(scratch / "biped", fresh, fs::copy_options::recursive);
        std::error_code is_there_already;
        fs::rename(fresh, kept, is_there_already);
        if (is_there_already) fs::remove_all(fresh);
        return;
    }
    fs::copy(kept, scratch / "biped", fs::copy_options::recursive);
}

std::string content_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    EXPECT_TRUE(file) << path << " cannot be read";
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void write_content(const std::filesystem::path& path, const std::string& content) {
    std::ofstream(path, std::ios::binary) << content;
}

}  // namespace kinequad::test
