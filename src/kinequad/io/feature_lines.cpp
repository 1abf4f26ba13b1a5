#include "kinequad/io/feature_lines.h"

#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "kinequad/core/error.h"
#include "kinequad/io/files.h"

namespace kinequad {
namespace {

using Json = nlohmann::json;

[[noreturn]] void refuse(const std::string& name, const std::string& what) {
    throw InputError(InputFault::file, name + ": " + what);
}

}  // namespace

FeatureLines parse_feature_lines(std::string_view text, const std::string& name) {
    const Json file = Json::parse(text, nullptr, false);
    if (file.is_discarded()) refuse(name, "is no valid JSON");
    if (!file.is_object() || !file.contains("lines") || !file["lines"].is_array()) {
        refuse(name, R"(has to hold {"lines": [[i, j, ...], ...]})");
    }
    FeatureLines features;
    for (std::size_t i = 0; const Json& line : file["lines"]) {
        if (!line.is_array() || line.size() < 2) {
            refuse(name, fmt::format("lines[{}] has to be a list of two vertices or more", i));
        }
        std::vector<int> vertices;
        for (const Json& vertex : line) {
            const bool is_whole = vertex.is_number_unsigned() &&
                                  vertex.get<std::uint64_t>() <=
                                      static_cast<std::uint64_t>(std::numeric_limits<int>::max());
            if (!is_whole) {
                refuse(name, fmt::format("lines[{}][{}] is no vertex; write a whole number from 0",
                                         i, vertices.size()));
            }
            vertices.push_back(vertex.get<int>());
        }
        for (std::size_t k = 1; k < vertices.size(); ++k) {
            features.push_back({vertices[k - 1], vertices[k]});
        }
        ++i;
    }
    return features;
}

FeatureLines read_feature_lines(const std::filesystem::path& path) {
    return parse_feature_lines(read_text_file(path), path.string());
}

}  // namespace kinequad
