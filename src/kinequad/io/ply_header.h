#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kinequad {

enum class PlyEncoding { ascii, little_endian, big_endian };

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Bytes of a number of this type.
int size_of(PlyType type);

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;
    bool is_list = false;
    PlyType count_type = PlyType::uint8;  ///< type of a list's length
};

struct PlyElement {
    std::string name;
    int count = 0;
    std::vector<PlyProperty> properties;
};

struct PlyHeader {
    PlyEncoding encoding = PlyEncoding::ascii;
    std::vector<PlyElement> elements;
    std::size_t size = 0;  ///< bytes of the header with the line end behind end_header
};

/// Reads the header of a PLY file and checks that its counts can fit the bytes behind it.
/// Throws `InputError` (file) with the line otherwise.
PlyHeader parse_ply_header(std::string_view bytes, const std::string& name);

}  // namespace kinequad
