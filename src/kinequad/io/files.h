#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace kinequad {

/// Extension of a path in lower case with its dot, as ".obj"; empty where there is none.
std::string extension_of(const std::filesystem::path& path);

/// Throws `InputError` (file) that names the file and what is wrong with it.
[[noreturn]] void refuse_file(const std::filesystem::path& path, const std::string& what);

/// All bytes of a file. Throws `InputError` (file) where it does not exist or cannot be read.
std::string read_text_file(const std::filesystem::path& path);

/// Writes `content` to a temporary file beside `path` and renames it, so that `path` never holds
/// half of it. Creates missing folders. Throws `InputError` (file) where that fails.
void write_file_atomically(const std::filesystem::path& path, std::string_view content);

/// A file open for reading at any offset, from several threads at once.
class RandomAccessFile {
public:
    /// Throws `InputError` (file) where `path` is no file that can be read.
    explicit RandomAccessFile(const std::filesystem::path& path);
    RandomAccessFile(const RandomAccessFile&) = delete;
    RandomAccessFile& operator=(const RandomAccessFile&) = delete;
    ~RandomAccessFile();

    /// Size in bytes when the file was opened.
    std::uint64_t size() const { return size_; }
    /// Fills `bytes` from `offset` on. Throws `InputError` (file) where the file ends before.
    void read(std::uint64_t offset, std::span<char> bytes) const;
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
    int descriptor_ = -1;
    std::uint64_t size_ = 0;
};

}  // namespace kinequad
