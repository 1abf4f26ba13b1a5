#include "kinequad/io/landmarks.h"

#include <fmt/format.h>

#include <functional>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "kinequad/core/error.h"
#include "kinequad/io/files.h"

namespace kinequad {
namespace {

using Json = nlohmann::json;

/// One line of what the JSON library says, without its own prefix.
std::string one_line(const std::string& message) {
    const std::size_t prefix = message.find("] ");
    std::string line = prefix == std::string::npos ? message : message.substr(prefix + 2);
    for (char& c : line) {
        if (c < ' ' || c > '~') c = ' ';
    }
    return line;
}

int read_vertex(const Json& value, const std::string& name, const std::string& element) {
    if (!value.is_number_integer()) {
        throw InputError(
            InputFault::file,
            fmt::format("{}: {} is no vertex index; write a whole number from 0", name, element));
    }
    // Indices beyond 2^63 come as unsigned and look negative here: refused all the same.
    const auto vertex = value.get<std::int64_t>();
    if (vertex < 0 || vertex > std::numeric_limits<int>::max()) {
        throw InputError(InputFault::symmetry,
                         fmt::format("{}: {} is {}, but vertices are counted from 0 to below their "
                                     "number",
                                     name, element, value.dump()));
    }
    return static_cast<int>(vertex);
}

std::vector<Json> list_of(const Json& file, const char* key, const std::string& name) {
    const auto found = file.find(key);
    if (found == file.end()) return {};
    if (!found->is_array()) {
        throw InputError(InputFault::file, fmt::format("{}: \"{}\" has to be a list", name, key));
    }
    return *found;
}

/// Calls `look` for every vertex that is named, with what messages call its place.
void for_each_vertex(const Landmarks& landmarks,
                     const std::function<void(int vertex, const std::string& place)>& look) {
    for (std::size_t p = 0; p < landmarks.pairs.size(); ++p) {
        for (std::size_t k = 0; k < 2; ++k) {
            look(landmarks.pairs[p][k], fmt::format("pairs[{}][{}]", p, k));
        }
    }
    for (std::size_t s = 0; s < landmarks.stationary.size(); ++s) {
        look(landmarks.stationary[s], fmt::format("stationary[{}]", s));
    }
}

}  // namespace

Landmarks parse_landmarks(std::string_view text, const std::string& name) {
    Json file;
    try {
        file = Json::parse(text);
    } catch (const Json::exception& error) {
        throw InputError(InputFault::file,
                         fmt::format("{}: is no valid JSON: {}", name, one_line(error.what())));
    }
    if (!file.is_object()) {
        throw InputError(
            InputFault::file,
            name + R"(: has to hold {"pairs": [[i, j], ...], "stationary": [k, ...]})");
    }
    // A misspelt key would leave a symmetry by what else is there.
    if (!file.contains("pairs")) {
        throw InputError(
            InputFault::file,
            name +
                R"(: has no "pairs"; write "pairs": [] where only stationary vertices are known)");
    }
    Landmarks landmarks;
    landmarks.name = name;
    for (std::size_t p = 0; const Json& pair : list_of(file, "pairs", name)) {
        if (!pair.is_array() || pair.size() != 2) {
            throw InputError(InputFault::file,
                             fmt::format("{}: pairs[{}] has to be two vertex indices", name, p));
        }
        landmarks.pairs.push_back({read_vertex(pair[0], name, fmt::format("pairs[{}][0]", p)),
                                   read_vertex(pair[1], name, fmt::format("pairs[{}][1]", p))});
        ++p;
    }
    for (std::size_t s = 0; const Json& vertex : list_of(file, "stationary", name)) {
        landmarks.stationary.push_back(read_vertex(vertex, name, fmt::format("stationary[{}]", s)));
        ++s;
    }
    require_named_once(landmarks);
    return landmarks;
}

Landmarks read_landmarks(const std::filesystem::path& path) {
    return parse_landmarks(read_text_file(path), path.string());
}

void require_named_once(const Landmarks& landmarks) {
    for (std::size_t p = 0; p < landmarks.pairs.size(); ++p) {
        const auto& [a, b] = landmarks.pairs[p];
        if (a != b) continue;
        throw InputError(InputFault::symmetry,
                         fmt::format("{}: pairs[{}] joins vertex {} to itself; if it lies on the "
                                     "line of symmetry, name it under \"stationary\"",
                                     landmarks.name, p, a));
    }
    std::map<int, std::string> seen;
    for_each_vertex(landmarks, [&](int vertex, const std::string& place) {
        const auto [first, is_new] = seen.emplace(vertex, place);
        if (is_new) return;
        throw InputError(InputFault::symmetry,
                         fmt::format("{}: vertex {} is named twice, as {} and {}; name it in one "
                                     "pair or once as stationary",
                                     landmarks.name, vertex, first->second, place));
    });
}

void require_landmarks_fit(const Landmarks& landmarks, int vertex_count) {
    for_each_vertex(landmarks, [&](int vertex, const std::string& place) {
        if (vertex >= 0 && vertex < vertex_count) return;
        throw InputError(InputFault::symmetry,
                         fmt::format("{}: {} is {}, but the mesh has {} vertices, counted from 0",
                                     landmarks.name, place, vertex, vertex_count));
    });
}

}  // namespace kinequad
