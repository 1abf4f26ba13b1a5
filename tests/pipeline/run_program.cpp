#include "run_program.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>

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
    const Outcome outcome =
        run_program(scratch, "synth biped -o biped --triangles 3000 --frames 4 -q");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
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
