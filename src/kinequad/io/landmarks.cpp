#include "kinequad/io/landmarks.h"

#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <set>

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
        throw InputError(
            InputFault::symmetry,
            fmt::format("{}: {} is {}, but vertices are counted from 0", name, element, vertex));
    }
    return static_cast<int>(vertex);
}

const Json& find_list(const Json& file, const char* key, const std::string& name) {
    static const Json nothing = Json::array();
    const auto found = file.find(key);
    if (found == file.end()) return nothing;
    if (!found->is_array()) {
        throw InputError(InputFault::file, fmt::format("{}: \"{}\" has to be a list", name, key));
    }
    return *found;
}

void require_named_once(const Landmarks& landmarks, const std::string& name) {
    std::set<int> seen;
    const auto check = [&](int vertex) {
        if (seen.insert(vertex).second) return;
        throw InputError(InputFault::symmetry,
                         fmt::format("{}: vertex {} is named twice; name it in one pair or once as "
                                     "stationary",
                                     name, vertex));
    };
    for (const auto& [a, b] : landmarks.pairs) {
        check(a);
        check(b);
    }
    for (const int vertex : landmarks.stationary) check(vertex);
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
    Landmarks landmarks;
    for (std::size_t p = 0; const Json& pair : find_list(file, "pairs", name)) {
        if (!pair.is_array() || pair.size() != 2) {
            throw InputError(InputFault::file,
                             fmt::format("{}: pairs[{}] has to be two vertex indices", name, p));
        }
        landmarks.pairs.push_back({read_vertex(pair[0], name, fmt::format("pairs[{}][0]", p)),
                                   read_vertex(pair[1], name, fmt::format("pairs[{}][1]", p))});
        ++p;
    }
    for (std::size_t s = 0; const Json& vertex : find_list(file, "stationary", name)) {
        landmarks.stationary.push_back(read_vertex(vertex, name, fmt::format("stationary[{}]", s)));
        ++s;
    }
    require_named_once(landmarks, name);
    return landmarks;
}

Landmarks read_landmarks(const std::filesystem::path& path) {
    return parse_landmarks(read_text_file(path), path.string());
}

void require_landmarks_fit(const Landmarks& landmarks, int vertex_count, const std::string& name) {
    const auto check = [&](int vertex) {
        if (vertex < vertex_count) return;
        throw InputError(
            InputFault::symmetry,
            fmt::format("{}: names vertex {}, but the mesh has {} vertices, counted from 0", name,
                        vertex, vertex_count));
    };
    for (const auto& [a, b] : landmarks.pairs) {
        check(a);
        check(b);
    }
    for (const int vertex : landmarks.stationary) check(vertex);
}

}  // namespace kinequad
