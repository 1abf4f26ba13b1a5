#include "kinequad/io/read_obj.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <vector>

#include "kinequad/core/index.h"
#include "kinequad/io/text_scanner.h"

namespace kinequad {
namespace {

enum class Line { vertex, face, other };

/// Steps over the keyword of the line at the scanner; the scanner stands before its first argument.
Line read_keyword(TextScanner& scanner) {
    scanner.skip_blanks();
    const std::string_view rest = scanner.rest();
    if (rest.empty() || (rest[0] != 'v' && rest[0] != 'f')) return Line::other;
    if (rest.size() > 1 && !TextScanner::is_blank(rest[1]) && !TextScanner::is_newline(rest[1]) &&
        rest[1] != '\\') {
        return Line::other;
    }
    scanner.set_position(scanner.position() + 1);
    scanner.skip_blanks();
    return rest[0] == 'v' ? Line::vertex : Line::face;
}

Vector3 read_vertex(TextScanner& scanner, std::size_t index) {
    const std::size_t start = scanner.position();
    Vector3 p;
    for (int k = 0; k < 3; ++k) {
        scanner.skip_blanks();
        p[k] = scanner.read_number("a coordinate");
    }
    if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) {
        scanner.fail_at(start, InputFault::mesh,
                        fmt::format("vertex {} is not finite; give it a position", index));
    }
    scanner.skip_joined_lines();
    return p;
}

/// Passes over the texture coordinate and the normal of a corner, as in "/2" and "/2/3" and "//3".
void skip_attributes(TextScanner& scanner) {
    const std::string_view attributes = scanner.read_token();
    if (attributes.empty()) return;
    if (attributes[0] == '/' &&
        attributes.find_first_not_of("/-0123456789") == std::string_view::npos) {
        return;
    }
    scanner.fail(InputFault::file,
                 "a face corner cannot be read; write it as v, v/vt, v//vn or v/vt/vn");
}

class ObjParser {
public:
    ObjParser(std::string_view text, const std::string& name) : scanner_(text, name), name_(name) {}

    PolygonMesh parse() {
        while (!scanner_.at_end()) parse_line();
        if (points_.empty()) {
            throw InputError(InputFault::mesh, name_ + ": has no vertices; is it a mesh?");
        }
        if (mesh_.faces.count() == 0) {
            throw InputError(InputFault::mesh,
                             name_ + ": has no faces; a mesh with triangles is needed");
        }
        check_indices();
        mesh_.V = Eigen::Map<const Positions>(points_.data()->data(),
                                              static_cast<Eigen::Index>(points_.size()), 3);
        return std::move(mesh_);
    }

private:
    void parse_line() {
        const std::size_t start = scanner_.position();
        switch (read_keyword(scanner_)) {
            case Line::vertex:
                points_.push_back(read_vertex(scanner_, points_.size()));
                if (points_.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
                    scanner_.fail(InputFault::mesh, "more than 2147483647 vertices");
                }
                break;
            case Line::face:
                face_position_.push_back(start);
                parse_face(start);
                break;
            case Line::other:
                scanner_.skip_joined_lines();
                break;
        }
    }

    void parse_face(std::size_t start) {
        face_.clear();
        for (; !scanner_.at_line_end(); scanner_.skip_blanks()) {
            const std::int64_t index = scanner_.read_integer_prefix("a vertex index");
            skip_attributes(scanner_);
            face_.push_back(resolve(index, start));
        }
        scanner_.skip_line();
        if (face_.size() < 3) {
            scanner_.fail_at(
                start, InputFault::file,
                fmt::format("face {} has {} corners, at least 3 are needed; is the file cut off?",
                            mesh_.faces.count(), face_.size()));
        }
        mesh_.faces.add(face_);
    }

    /// 0-based vertex of an index as the file has it: from 1, or negative and counted backwards.
    int resolve(std::int64_t index, std::size_t start) const {
        const auto known = static_cast<std::int64_t>(points_.size());
        if (index > 0 && index <= std::numeric_limits<int>::max())
            return static_cast<int>(index - 1);
        if (index < 0 && index >= -known) return static_cast<int>(known + index);
        fail_index(start, index, known);
    }

    [[noreturn]] void fail_index(std::size_t start, std::int64_t index, std::int64_t known) const {
        scanner_.fail_at(start, InputFault::mesh,
                         fmt::format("a face names vertex {}, but there are {} vertices; "
                                     "indices run from 1 to the number of vertices",
                                     index, known));
    }

    // A face may come before its vertices: only at the end is it known which indices exist.
    void check_indices() const {
        const auto known = static_cast<int>(points_.size());
        for (int f = 0; f < mesh_.faces.count(); ++f) {
            for (const int vertex : mesh_.faces[f]) {
                if (vertex < known) continue;
                fail_index(face_position_[at(f)], std::int64_t{vertex} + 1, known);
            }
        }
    }

    TextScanner scanner_;
    const std::string& name_;
    std::vector<Vector3> points_;
    std::vector<std::size_t> face_position_;
    std::vector<int> face_;
    PolygonMesh mesh_;
};

}  // namespace

PolygonMesh parse_obj(std::string_view text, const std::string& name) {
    return ObjParser(text, name).parse();
}

ObjPattern find_obj_pattern(std::string_view text, const std::string& name) {
    TextScanner scanner(text, name);
    ObjPattern pattern;
    std::size_t behind_vertices = 0;
    bool face_seen = false;
    while (!scanner.at_end()) {
        const Line line = read_keyword(scanner);
        scanner.skip_joined_lines();
        if (line == Line::face) face_seen = true;
        if (line != Line::vertex) continue;
        if (face_seen) return {};
        ++pattern.vertex_count;
        behind_vertices = scanner.position();
    }
    pattern.tail = text.substr(behind_vertices);
    return pattern;
}

std::optional<Positions> parse_obj_positions(std::string_view text, const std::string& name,
                                             const ObjPattern& pattern) {
    if (pattern.tail.empty() || !text.ends_with(pattern.tail)) return std::nullopt;
    const std::size_t end = text.size() - pattern.tail.size();
    TextScanner scanner(text, name);
    Positions V(pattern.vertex_count, 3);
    int count = 0;
    while (scanner.position() < end) {
        switch (read_keyword(scanner)) {
            case Line::vertex:
                if (count == pattern.vertex_count) return std::nullopt;
                V.row(count) = read_vertex(scanner, static_cast<std::size_t>(count)).transpose();
                ++count;
                break;
            case Line::face:
                return std::nullopt;
            case Line::other:
                scanner.skip_joined_lines();
                break;
        }
    }
    if (scanner.position() != end || count != pattern.vertex_count) return std::nullopt;
    return V;
}

}  // namespace kinequad
