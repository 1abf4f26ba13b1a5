#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kinequad::app {

/// Where a command writes its files: they are made in a hidden folder inside the wanted one and
/// moved to their places together by `commit`. A command that fails or is cancelled before leaves
/// nothing behind, not even the wanted folder where it was not there before.
class OutputFolder {
public:
    /// Makes `folder` where it is absent. Throws `InputError` (file) where it cannot.
    explicit OutputFolder(const std::filesystem::path& folder);
    ~OutputFolder();
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

    /// Place for the file or subfolder `name` until `commit`.
    std::filesystem::path path(const std::string& name) const { return partial_ / name; }
    /// Where `path(name)` is after `commit`.
    std::filesystem::path final_path(const std::string& name) const { return folder_ / name; }
    /// Has `commit` remove the file or folder `name` of an earlier command where this one made
    /// none.
    void replace_earlier(const std::string& name) { earlier_.push_back(name); }
    /// Moves everything made so far to its final place, over what was there under the same names.
    /// Throws `InputError` (file) where that fails.
    void commit();

    /// Removes the hidden folders of every uncommitted output of this process. For the moment
    /// before the process ends; safe to call from any thread.
    static void remove_unfinished();

private:
    void remove() noexcept;

    std::filesystem::path folder_;
    std::filesystem::path partial_;
    std::vector<std::string> earlier_;
    std::filesystem::path first_made_;  ///< topmost folder that was not there before; may be empty
};

}  // namespace kinequad::app
