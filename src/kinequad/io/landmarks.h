#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace kinequad {

/// What the user knows about the symmetry of a mesh.
struct Landmarks {
    std::vector<std::array<int, 2>> pairs;  ///< 0-based vertices that mirror each other
    std::vector<int> stationary;            ///< 0-based vertices on the line of symmetry
    std::string name = "landmarks";         ///< what messages call them: the file
};

/// Reads the text of a landmarks file, {"pairs": [[i, j], ...], "stationary": [k, ...]}; the second
/// may be absent, other keys are passed over. `name` is what messages call the file. Throws
/// `InputError` (file) where the text is no such JSON, (symmetry) where an index is negative, a
/// pair joins a vertex to itself, or a vertex is named twice.
Landmarks parse_landmarks(std::string_view text, const std::string& name);

/// As `parse_landmarks`, for the file at `path`.
Landmarks read_landmarks(const std::filesystem::path& path);

/// Throws `InputError` (symmetry), naming the places, where a pair joins a vertex to itself or a
/// vertex is named twice.
void require_named_once(const Landmarks& landmarks);

/// Throws `InputError` (symmetry), naming the place, unless every landmark is a vertex, from 0 to
/// below `vertex_count`.
void require_landmarks_fit(const Landmarks& landmarks, int vertex_count);

}  // namespace kinequad
