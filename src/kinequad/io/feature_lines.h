#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace kinequad {

/// Edges that quads have to follow, as pairs of 0-based vertices of the input.
using FeatureLines = std::vector<std::array<int, 2>>;

/// Reads the text of a file of feature lines, {"lines": [[i, j, k, ...], ...]}: each a chain of at
/// least two 0-based vertices, one joined to the next by an edge; other keys are passed over.
/// `name` is what messages call the file. Throws `InputError` (file) where the text is no such
/// JSON.
FeatureLines parse_feature_lines(std::string_view text, const std::string& name);

/// As `parse_feature_lines`, for the file at `path`.
FeatureLines read_feature_lines(const std::filesystem::path& path);

}  // namespace kinequad
