#include "kinequad/io/pending_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "kinequad/core/error.h"

namespace kinequad {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what,
                       const std::error_code& reason) {
    throw InputError(InputFault::file,
                     fmt::format("{}: {}: {}", path.string(), what, reason.message()));
}

std::error_code last_error() { return {errno, std::generic_category()}; }

}  // namespace

PendingFiles::PendingFiles(const std::filesystem::path& directory) : directory_(directory) {
    make_directory();
}

PendingFiles::~PendingFiles() {
    if (descriptor_ >= 0) ::close(descriptor_);
    std::error_code ignored;
    for (std::size_t i = renamed_; i < files_.size(); ++i) {
        std::filesystem::remove(files_[i].temporary, ignored);
    }
    if (renamed_ == files_.size() && renamed_ > 0) return;
    // Removes empty folders only: what others put there meanwhile stays.
    for (auto made = made_directories_.rbegin(); made != made_directories_.rend(); ++made) {
        std::filesystem::remove(*made, ignored);
    }
}

void PendingFiles::make_directory() {
    if (directory_.empty()) return;
    std::vector<std::filesystem::path> missing;
    std::error_code reason;
    for (std::filesystem::path p = directory_; !p.empty() && !std::filesystem::exists(p, reason);
         p = p.parent_path()) {
        missing.push_back(p);
    }
    for (auto p = missing.rbegin(); p != missing.rend(); ++p) {
        if (std::filesystem::create_directory(*p, reason)) made_directories_.push_back(*p);
        if (reason) fail(*p, "folder cannot be made", reason);
    }
    if (!std::filesystem::is_directory(directory_, reason)) {
        throw InputError(InputFault::file,
                         fmt::format("{}: is not a folder; name another one", directory_.string()));
    }
}

void PendingFiles::open(const std::string& name) {
    close();
    File file;
    file.final = directory_ / name;
    file.temporary = directory_ / fmt::format(".{}.{}.part", name, ::getpid());
    descriptor_ = ::open(file.temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail(file.final, "cannot be written", last_error());
    files_.push_back(std::move(file));
}

void PendingFiles::write(std::string_view bytes) {
    while (!bytes.empty()) {
        const ::ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
        if (written < 0) {
            if (errno == EINTR) continue;
            fail(files_.back().final, "cannot be written", last_error());
        }
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
}

void PendingFiles::close() {
    if (descriptor_ < 0) return;
    const int result = ::close(descriptor_);
    descriptor_ = -1;
    if (result != 0) fail(files_.back().final, "cannot be written", last_error());
}

void PendingFiles::commit() {
    close();
    // A folder in the way would stop the renaming half-way: look before the first one.
    for (const File& file : files_) {
        std::error_code reason;
        if (std::filesystem::is_directory(file.final, reason)) {
            fail(file.final, "cannot be written", std::make_error_code(std::errc::is_a_directory));
        }
    }
    for (; renamed_ < files_.size(); ++renamed_) {
        std::error_code reason;
        std::filesystem::rename(files_[renamed_].temporary, files_[renamed_].final, reason);
        if (reason) fail(files_[renamed_].final, "cannot be written", reason);
    }
}

std::vector<std::filesystem::path> PendingFiles::paths() const {
    std::vector<std::filesystem::path> paths;
    paths.reserve(files_.size());
    for (const File& file : files_) paths.push_back(file.final);
    return paths;
}

}  // namespace kinequad
