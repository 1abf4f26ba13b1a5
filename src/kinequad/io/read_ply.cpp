#include "kinequad/io/read_ply.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "kinequad/io/byte_order.h"
#include "kinequad/io/ply_header.h"
#include "kinequad/io/text_scanner.h"

namespace kinequad {
namespace {

/// Hands out the numbers of the body of an ascii PLY.
class AsciiBody {
public:
    AsciiBody(std::string_view bytes, const std::string& name, const PlyHeader& header)
        : scanner_(bytes, name, '\n') {
        scanner_.set_position(header.size);
    }
    double read_number(PlyType) {
        scanner_.skip_to_token();
        return scanner_.read_number("a number");
    }
    std::int64_t read_integer(PlyType) {
        scanner_.skip_to_token();
        return scanner_.read_integer("a whole number");
    }
    std::size_t remaining() const { return scanner_.rest().size(); }
    bool at_end() {
        scanner_.skip_to_token();
        return scanner_.at_end();
    }
    [[noreturn]] void fail(InputFault fault, const std::string& message) const {
        scanner_.fail(fault, message);
    }

private:
    TextScanner scanner_;
};

/// Hands out the numbers of the body of a binary PLY.
class BinaryBody {
public:
    BinaryBody(std::string_view bytes, const std::string& name, const PlyHeader& header)
        : bytes_(bytes),
          name_(name),
          position_(header.size),
          order_(header.encoding == PlyEncoding::big_endian ? std::endian::big
                                                            : std::endian::little) {}
    double read_number(PlyType type) {
        switch (type) {
            case PlyType::float32:
                return take<float>();
            case PlyType::float64:
                return take<double>();
            default:
                return static_cast<double>(read_integer(type));
        }
    }
    std::int64_t read_integer(PlyType type) {
        switch (type) {
            case PlyType::int8:
                return take<std::int8_t>();
            case PlyType::uint8:
                return take<std::uint8_t>();
            case PlyType::int16:
                return take<std::int16_t>();
            case PlyType::uint16:
                return take<std::uint16_t>();
            case PlyType::int32:
                return take<std::int32_t>();
            case PlyType::uint32:
                return take<std::uint32_t>();
            case PlyType::float32:
            case PlyType::float64:
                break;
        }
        fail(InputFault::file, "a whole number expected in the faces, the header says a real one");
    }
    std::size_t remaining() const { return bytes_.size() - position_; }
    bool at_end() const {
        // Some programs end even a binary file with a line end.
        return bytes_.find_first_not_of("\r\n", position_) == std::string_view::npos;
    }
    [[noreturn]] void fail(InputFault fault, const std::string& message) const {
        throw InputError(fault, fmt::format("{}: {}", name_, message));
    }

private:
    template <class T>
    T take() {
        if (remaining() < sizeof(T)) fail(InputFault::file, "ends too early; is it cut off?");
        const T value = load_number<T>(bytes_.data() + position_, order_);
        position_ += sizeof(T);
        return value;
    }

    std::string_view bytes_;
    const std::string& name_;
    std::size_t position_;
    std::endian order_;
};

/// Length of the list that begins here; at most what the bytes ahead can hold.
template <class Body>
std::int64_t read_length(Body& body, const PlyProperty& property) {
    const std::int64_t length = body.read_integer(property.count_type);
    if (length < 0 || static_cast<std::uint64_t>(length) > body.remaining()) {
        body.fail(
            InputFault::file,
            fmt::format("a list of {} numbers is longer than the file; is it cut off?", length));
    }
    return length;
}

template <class Body>
void skip_property(Body& body, const PlyProperty& property) {
    const std::int64_t length = property.is_list ? read_length(body, property) : 1;
    for (std::int64_t k = 0; k < length; ++k) body.read_number(property.type);
}

template <class Body>
Positions read_vertices(Body& body, const PlyElement& element) {
    std::vector<int> axis;
    int found = 0;
    for (const PlyProperty& property : element.properties) {
        const bool is_axis = !property.is_list &&
                             (property.name == "x" || property.name == "y" || property.name == "z");
        axis.push_back(is_axis ? property.name[0] - 'x' : -1);
        if (is_axis) found |= 1 << axis.back();
    }
    if (found != 7) body.fail(InputFault::file, "its vertices lack one of x, y and z");
    Positions V(element.count, 3);
    for (int i = 0; i < element.count; ++i) {
        for (std::size_t p = 0; p < axis.size(); ++p) {
            if (axis[p] < 0) {
                skip_property(body, element.properties[p]);
            } else {
                V(i, axis[p]) = body.read_number(element.properties[p].type);
            }
        }
        if (!V.row(i).allFinite()) {
            body.fail(InputFault::mesh,
                      fmt::format("vertex {} is not finite; give it a position", i));
        }
    }
    return V;
}

template <class Body>
Polygons read_faces(Body& body, const PlyElement& element) {
    const auto is_corners = [](const PlyProperty& property) {
        return property.is_list &&
               (property.name == "vertex_indices" || property.name == "vertex_index");
    };
    int lists = 0;
    for (const PlyProperty& property : element.properties) lists += is_corners(property) ? 1 : 0;
    if (lists != 1) body.fail(InputFault::file, "its faces lack the list vertex_indices");
    Polygons faces;
    std::vector<int> face;
    for (int f = 0; f < element.count; ++f) {
        for (const PlyProperty& property : element.properties) {
            if (!is_corners(property)) {
                skip_property(body, property);
                continue;
            }
            const std::int64_t length = read_length(body, property);
            if (length < 3) {
                body.fail(InputFault::file,
                          fmt::format("face {} has {} corners, at least 3 are needed", f, length));
            }
            face.clear();
            for (std::int64_t k = 0; k < length; ++k) {
                const std::int64_t vertex = body.read_integer(property.type);
                // Compared with the number of vertices below: they may come behind the faces.
                if (vertex < 0 || vertex > 0x7fffffff) {
                    body.fail(
                        InputFault::mesh,
                        fmt::format("face {} names vertex {}, which does not exist", f, vertex));
                }
                face.push_back(static_cast<int>(vertex));
            }
            faces.add(face);
        }
    }
    return faces;
}

void check_mesh(const PolygonMesh& mesh, const std::string& name) {
    const auto vertex_count = static_cast<int>(mesh.V.rows());
    if (vertex_count == 0) {
        throw InputError(InputFault::mesh, name + ": has no vertices; is it a mesh?");
    }
    if (mesh.faces.count() == 0) {
        throw InputError(InputFault::mesh,
                         name + ": has no faces; a mesh with triangles is needed");
    }
    for (int f = 0; f < mesh.faces.count(); ++f) {
        for (const int vertex : mesh.faces[f]) {
            if (vertex < vertex_count) continue;
            throw InputError(
                InputFault::mesh,
                fmt::format("{}: face {} names vertex {}, but indices run from 0 to {}", name, f,
                            vertex, vertex_count - 1));
        }
    }
}

template <class Body>
PolygonMesh read_body(Body body, const PlyHeader& header, const std::string& name) {
    PolygonMesh mesh;
    for (const PlyElement& element : header.elements) {
        if (element.name == "vertex" && mesh.V.rows() == 0) {
            mesh.V = read_vertices(body, element);
        } else if (element.name == "face" && mesh.faces.count() == 0) {
            mesh.faces = read_faces(body, element);
        } else if (!element.properties.empty()) {
            for (int i = 0; i < element.count; ++i) {
                for (const PlyProperty& property : element.properties)
                    skip_property(body, property);
            }
        }
    }
    check_mesh(mesh, name);
    if (!body.at_end()) {
        body.fail(InputFault::file,
                  "goes on behind the last element; the counts of its header are wrong");
    }
    return mesh;
}

}  // namespace

PolygonMesh parse_ply(std::string_view bytes, const std::string& name) {
    const PlyHeader header = parse_ply_header(bytes, name);
    if (header.encoding == PlyEncoding::ascii) {
        return read_body(AsciiBody(bytes, name, header), header, name);
    }
    return read_body(BinaryBody(bytes, name, header), header, name);
}

}  // namespace kinequad
