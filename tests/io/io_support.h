#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "kinequad/core/error.h"
#include "kinequad/io/files.h"
#include "kinequad/io/polygons.h"

namespace kinequad::test {

/// A folder of its own that is gone with the object.
class ScratchFolder {
public:
    ScratchFolder() {
        std::string pattern =
            (std::filesystem::temp_directory_path() / "kinequad-io-XXXXXX").string();
        if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no scratch folder");
        path_ = pattern;
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    ~ScratchFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    std::string path() const { return path_.string(); }
    /// Writes a file and returns its path.
    std::string put(const std::string& name, const std::string& content) const {
        write_file_atomically(path_ / name, content);
        return (path_ / name).string();
    }
    /// Names of all entries, hidden ones too, in order.
    std::vector<std::string> entries() const {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(path_)) {
            names.push_back(entry.path().filename().string());
        }
        std::sort(names.begin(), names.end());
        return names;
    }

private:
    std::filesystem::path path_;
};

/// Expects `action` to throw an `InputError` of this fault whose one line holds all of `parts`.
inline void expect_input_error(const std::function<void()>& action, InputFault fault,
                               const std::vector<std::string>& parts) {
    try {
        action();
    } catch (const InputError& error) {
        const std::string message = error.what();
        EXPECT_EQ(error.fault(), fault) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        for (const std::string& part : parts) {
            EXPECT_NE(message.find(part), std::string::npos) << message << "\nlacks: " << part;
        }
        return;
    }
    ADD_FAILURE() << "nothing was thrown";
}

inline Polygons polygons_of(const std::vector<std::vector<int>>& faces) {
    Polygons polygons;
    for (const std::vector<int>& face : faces) polygons.add(face);
    return polygons;
}

inline Positions positions_of(const std::vector<Vector3>& points) {
    Positions V(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i) {
        V.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
    }
    return V;
}

/// True where both arrays have the same size and the same bits.
inline bool same_bits(const Positions& a, const Positions& b) {
    return a.rows() == b.rows() &&
           std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) ==
               0;
}

}  // namespace kinequad::test
