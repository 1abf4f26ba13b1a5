#include "kinequad/io/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "kinequad/core/error.h"
#include "kinequad/io/pending_files.h"

namespace kinequad {

void refuse_file(const std::filesystem::path& path, const std::string& what) {
    throw InputError(InputFault::file, fmt::format("{}: {}", path.string(), what));
}

std::string extension_of(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](char c) {
        return 'A' <= c && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return extension;
}

std::string read_text_file(const std::filesystem::path& path) {
    const RandomAccessFile file(path);
    std::string content(file.size(), '\0');
    file.read(0, content);
    return content;
}

void write_file_atomically(const std::filesystem::path& path, std::string_view content) {
    PendingFiles files(path.parent_path());
    files.open(path.filename().string());
    files.write(content);
    files.commit();
}

RandomAccessFile::RandomAccessFile(const std::filesystem::path& path) : path_(path) {
    descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor_ < 0) {
        refuse_file(path,
                    fmt::format("cannot be opened: {}", std::generic_category().message(errno)));
    }
    struct stat status {};
    const bool known = ::fstat(descriptor_, &status) == 0;
    if (!known || !S_ISREG(status.st_mode)) {
        ::close(descriptor_);
        refuse_file(path, "is not a regular file");
    }
    size_ = static_cast<std::uint64_t>(status.st_size);
}

RandomAccessFile::~RandomAccessFile() { ::close(descriptor_); }

void RandomAccessFile::read(std::uint64_t offset, std::span<char> bytes) const {
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ::ssize_t got = ::pread(descriptor_, bytes.data() + done, bytes.size() - done,
                                      static_cast<::off_t>(offset + done));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) {
            refuse_file(path_,
                        fmt::format("cannot be read: {}", std::generic_category().message(errno)));
        }
        if (got == 0) refuse_file(path_, "became shorter while it was read; run again");
        done += static_cast<std::size_t>(got);
    }
}

}  // namespace kinequad
