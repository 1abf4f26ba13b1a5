#include "kinequad/io/encode_mesh.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cstdint>

#include "kinequad/io/byte_order.h"

namespace kinequad {
namespace {

template <class Number>
void append_number(std::string& text, Number number) {
    // 24 characters hold any double in its shortest form, and any integer.
    std::array<char, 32> digits;
    const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), number);
    static_cast<void>(error);
    text.append(digits.data(), end);
}

void append_positions(std::string& text, const Positions& V, const char* prefix) {
    for (Eigen::Index i = 0; i < V.rows(); ++i) {
        text += prefix;
        for (Eigen::Index k = 0; k < 3; ++k) {
            if (k > 0) text += ' ';
            append_number(text, V(i, k));
        }
        text += '\n';
    }
}

bool has_long_faces(const Polygons& faces) {
    for (int f = 0; f < faces.count(); ++f) {
        if (faces[f].size() > 255) return true;
    }
    return false;
}

template <class Number>
void append_bytes(std::string& bytes, Number number) {
    std::array<char, sizeof(Number)> raw;
    store_number(raw.data(), number, std::endian::little);
    bytes.append(raw.data(), raw.size());
}

}  // namespace

std::string encode_obj_positions(const Positions& V) {
    std::string text;
    text.reserve(static_cast<std::size_t>(V.rows()) * 60);
    append_positions(text, V, "v ");
    return text;
}

std::string encode_obj_faces(const Polygons& faces) {
    std::string text;
    text.reserve(faces.corners.size() * 7);
    for (int f = 0; f < faces.count(); ++f) {
        text += 'f';
        for (const int vertex : faces[f]) {
            text += ' ';
            append_number(text, std::int64_t{vertex} + 1);
        }
        text += '\n';
    }
    return text;
}

std::string encode_ply_header(int vertex_count, const Polygons& faces) {
    return fmt::format(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\nproperty "
        "double "
        "y\nproperty double z\nelement face {}\nproperty list {} int vertex_indices\nend_header\n",
        vertex_count, faces.count(), has_long_faces(faces) ? "int" : "uchar");
}

std::string encode_ply_positions(const Positions& V) {
    std::string bytes(static_cast<std::size_t>(V.size()) * sizeof(double), '\0');
    for (Eigen::Index k = 0; k < V.size(); ++k) {
        store_number(bytes.data() + static_cast<std::size_t>(k) * sizeof(double), V.data()[k],
                     std::endian::little);
    }
    return bytes;
}

std::string encode_ply_faces(const Polygons& faces) {
    const bool is_long = has_long_faces(faces);
    std::string bytes;
    bytes.reserve(faces.corners.size() * 4 + static_cast<std::size_t>(faces.count()) * 4);
    for (int f = 0; f < faces.count(); ++f) {
        const std::span<const int> face = faces[f];
        if (is_long) {
            append_bytes(bytes, static_cast<std::int32_t>(face.size()));
        } else {
            append_bytes(bytes, static_cast<std::uint8_t>(face.size()));
        }
        for (const int vertex : face) append_bytes(bytes, std::int32_t{vertex});
    }
    return bytes;
}

std::string encode_off(const Positions& V, const Polygons& faces) {
    std::string text = fmt::format("OFF\n{} {} 0\n", V.rows(), faces.count());
    append_positions(text, V, "");
    for (int f = 0; f < faces.count(); ++f) {
        append_number(text, faces[f].size());
        for (const int vertex : faces[f]) {
            text += ' ';
            append_number(text, vertex);
        }
        text += '\n';
    }
    return text;
}

}  // namespace kinequad
