#include "output_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <mutex>
#include <system_error>
#include <vector>

#include "kinequad/core/error.h"

namespace kinequad::app {
namespace {

std::mutex open_mutex;
std::vector<OutputFolder*> open_folders;

/// The topmost of `folder` and its parents that does not exist; empty where all exist.
std::filesystem::path topmost_absent(std::filesystem::path folder) {
    std::filesystem::path absent;
    while (!folder.empty() && !std::filesystem::exists(folder)) {
        absent = folder;
        folder = folder.parent_path();
    }
    return absent;
}

}  // namespace

OutputFolder::OutputFolder(const std::filesystem::path& folder)
    : folder_(std::filesystem::absolute(folder).lexically_normal()) {
    if (!folder_.has_filename()) folder_ = folder_.parent_path();
    partial_ = folder_ / fmt::format(".kinequad-{}", getpid());
    const std::lock_guard lock(open_mutex);
    first_made_ = topmost_absent(folder_);
    std::error_code error;
    std::filesystem::create_directories(partial_, error);
    if (error) {
        throw InputError(InputFault::file,
                         fmt::format("{}: cannot be made a folder ({}); choose another with -o",
                                     folder.string(), error.message()));
    }
    open_folders.push_back(this);
}

OutputFolder::~OutputFolder() {
    const std::lock_guard lock(open_mutex);
    std::erase(open_folders, this);
    remove();
}

void OutputFolder::commit() {
    const std::lock_guard lock(open_mutex);
    std::vector<std::filesystem::path> made;
    for (const auto& entry : std::filesystem::directory_iterator(partial_)) {
        made.push_back(entry.path());
    }
    std::sort(made.begin(), made.end());
    for (const std::filesystem::path& from : made) {
        const std::filesystem::path to = folder_ / from.filename();
        std::error_code error;
        // A folder of frames is replaced whole, so that no frame of an earlier run stays behind.
        if (std::filesystem::is_directory(to)) std::filesystem::remove_all(to, error);
        std::filesystem::rename(from, to, error);
        if (error) {
            throw InputError(InputFault::file, fmt::format("{}: cannot be written ({})",
                                                           to.string(), error.message()));
        }
    }
    for (const std::string& name : earlier_) {
        const auto has_name = [&](const auto& from) { return from.filename() == name; };
        std::error_code ignored;
        if (std::none_of(made.begin(), made.end(), has_name)) {
            std::filesystem::remove_all(folder_ / name, ignored);
        }
    }
    first_made_.clear();
}

void OutputFolder::remove() noexcept {
    std::error_code ignored;
    std::filesystem::remove_all(partial_, ignored);
    if (first_made_.empty()) return;
    // Only what is empty goes: somebody else may have put files there meanwhile.
    for (std::filesystem::path folder = folder_; std::filesystem::remove(folder, ignored);) {
        if (folder == first_made_) break;
        folder = folder.parent_path();
    }
}

void OutputFolder::remove_unfinished() {
    const std::lock_guard lock(open_mutex);
    for (OutputFolder* folder : open_folders) folder->remove();
}

}  // namespace kinequad::app
