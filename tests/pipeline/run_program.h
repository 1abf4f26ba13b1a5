#pragma once

#include <filesystem>
#include <string>

namespace kinequad::test {

/// How a run of the program ended and what it said.
struct Outcome {
    int code = -1;  ///< exit code
    std::string out;
    std::string err;
};

/// An empty folder for one test, removed at its end.
class ScratchFolder {
public:
    ScratchFolder();
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

/// Runs `kinequad ARGUMENTS`, the arguments as a shell reads them, and waits for its end.
Outcome run_program(const ScratchFolder& scratch, const std::string& arguments);

/// Makes the frames of a walking creature in the folder `biped`.
void make_biped(const ScratchFolder& scratch);

/// The content of a file; fails the test where it cannot be read.
std::string content_of(const std::filesystem::path& path);

/// Makes a file with the given content.
void write_content(const std::filesystem::path& path, const std::string& content);

}  // namespace kinequad::test
