#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace kinequad {

/// Files that are written under temporary names in their folder and appear under their own names
/// all together in `commit()`. Without `commit()` the destructor removes them, and the folder where
/// it was made here. Every member throws `InputError` (file) where the disk refuses.
class PendingFiles {
public:
    /// `directory` may be empty (the working directory); it is created where it is missing.
    explicit PendingFiles(const std::filesystem::path& directory);
    PendingFiles(const PendingFiles&) = delete;
    PendingFiles& operator=(const PendingFiles&) = delete;
    ~PendingFiles();

    /// Closes the file being written and begins the one that will be called `name`.
    void open(const std::string& name);
    /// Appends to the file begun last.
    void write(std::string_view bytes);
    /// Closes, and gives every file its own name, replacing files of that name.
    void commit();
    /// Final paths of all files begun so far.
    std::vector<std::filesystem::path> paths() const;

private:
    struct File {
        std::filesystem::path temporary;
        std::filesystem::path final;
    };
    void close();
    void make_directory();

    std::filesystem::path directory_;
    std::vector<std::filesystem::path> made_directories_;
    std::vector<File> files_;
    std::size_t renamed_ = 0;
    int descriptor_ = -1;
};

}  // namespace kinequad
