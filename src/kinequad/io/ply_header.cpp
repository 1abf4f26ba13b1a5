#include "kinequad/io/ply_header.h"

#include <fmt/format.h>

#include <array>
#include <limits>
#include <utility>

#include "kinequad/io/text_scanner.h"

namespace kinequad {
namespace {

PlyType read_type(TextScanner& scanner) {
    static constexpr std::array<std::pair<std::string_view, PlyType>, 16> names = {{
        {"char", PlyType::int8},
        {"int8", PlyType::int8},
        {"uchar", PlyType::uint8},
        {"uint8", PlyType::uint8},
        {"short", PlyType::int16},
        {"int16", PlyType::int16},
        {"ushort", PlyType::uint16},
        {"uint16", PlyType::uint16},
        {"int", PlyType::int32},
        {"int32", PlyType::int32},
        {"uint", PlyType::uint32},
        {"uint32", PlyType::uint32},
        {"float", PlyType::float32},
        {"float32", PlyType::float32},
        {"double", PlyType::float64},
        {"float64", PlyType::float64},
    }};
    scanner.skip_blanks();
    const std::string_view token = scanner.read_token();
    for (const auto& [name, type] : names) {
        if (name == token) return type;
    }
    scanner.fail(InputFault::file, "a property of an unknown type in the PLY header");
}

std::string read_name(TextScanner& scanner) {
    scanner.skip_blanks();
    const std::string_view token = scanner.read_token();
    if (token.empty()) scanner.fail(InputFault::file, "a name is missing in the PLY header");
    return std::string(token);
}

PlyEncoding read_encoding(TextScanner& scanner) {
    const std::string name = read_name(scanner);
    if (name == "ascii") return PlyEncoding::ascii;
    if (name == "binary_little_endian") return PlyEncoding::little_endian;
    if (name == "binary_big_endian") return PlyEncoding::big_endian;
    scanner.fail(InputFault::file,
                 "the format is none of ascii, binary_little_endian and binary_big_endian");
}

PlyElement read_element(TextScanner& scanner) {
    PlyElement element;
    element.name = read_name(scanner);
    scanner.skip_blanks();
    const std::int64_t count = scanner.read_integer("a number of elements");
    if (count < 0 || count > std::numeric_limits<int>::max()) {
        scanner.fail(InputFault::file, fmt::format("{} elements are not possible", count));
    }
    element.count = static_cast<int>(count);
    return element;
}

PlyProperty read_property(TextScanner& scanner) {
    PlyProperty property;
    scanner.skip_blanks();
    if (scanner.rest().starts_with("list")) {
        scanner.read_token();
        property.is_list = true;
        property.count_type = read_type(scanner);
        if (property.count_type == PlyType::float32 || property.count_type == PlyType::float64) {
            scanner.fail(InputFault::file, "the length of a list has to be a whole number");
        }
    }
    property.type = read_type(scanner);
    property.name = read_name(scanner);
    return property;
}

/// Fewest bytes that one element takes: numbers of their size, or one digit and what parts it from
/// the next; a list may be empty.
std::uint64_t smallest_size(const PlyElement& element, PlyEncoding encoding) {
    std::uint64_t size = 0;
    for (const PlyProperty& property : element.properties) {
        const PlyType first = property.is_list ? property.count_type : property.type;
        size += encoding == PlyEncoding::ascii ? 2 : static_cast<std::uint64_t>(size_of(first));
    }
    return size;
}

void check_counts(const PlyHeader& header, std::size_t file_size, const std::string& name) {
    // The last number of a text needs nothing behind it.
    std::uint64_t available =
        file_size - header.size + (header.encoding == PlyEncoding::ascii ? 1U : 0U);
    for (const PlyElement& element : header.elements) {
        const std::uint64_t smallest = smallest_size(element, header.encoding);
        const auto count = static_cast<std::uint64_t>(element.count);
        if (smallest > 0 && count > available / smallest) {
            throw InputError(
                InputFault::file,
                fmt::format("{}: the header says {} elements \"{}\", more than the file "
                            "holds; is it cut off?",
                            name, count, element.name));
        }
        available -= count * smallest;
    }
}

}  // namespace

int size_of(PlyType type) {
    switch (type) {
        case PlyType::int8:
        case PlyType::uint8:
            return 1;
        case PlyType::int16:
        case PlyType::uint16:
            return 2;
        case PlyType::int32:
        case PlyType::uint32:
        case PlyType::float32:
            return 4;
        case PlyType::float64:
            return 8;
    }
    return 8;
}

PlyHeader parse_ply_header(std::string_view bytes, const std::string& name) {
    // No character begins a comment: "comment" lines do.
    TextScanner scanner(bytes, name, '\n');
    if (scanner.read_token() != "ply") {
        scanner.fail(InputFault::file, "is no PLY file: it has to begin with ply");
    }
    PlyHeader header;
    bool has_format = false;
    while (true) {
        scanner.skip_to_token();
        if (scanner.at_end()) {
            scanner.fail(InputFault::file,
                         "the PLY header has no end_header; is the file cut off?");
        }
        const std::string_view keyword = scanner.read_token();
        if (keyword == "format") {
            header.encoding = read_encoding(scanner);
            has_format = true;
        } else if (keyword == "element") {
            header.elements.push_back(read_element(scanner));
        } else if (keyword == "property" && !header.elements.empty()) {
            header.elements.back().properties.push_back(read_property(scanner));
        } else if (keyword == "end_header") {
            break;
        } else if (keyword != "comment" && keyword != "obj_info") {
            scanner.fail(InputFault::file, "a line of the PLY header cannot be read");
        }
        scanner.skip_line();
    }
    if (!has_format) scanner.fail(InputFault::file, "the PLY header has no format line");
    // The data begins right behind the line feed: its first byte may look like anything.
    const std::size_t end = bytes.find('\n', scanner.position());
    if (end == std::string_view::npos) {
        scanner.fail(InputFault::file, "nothing follows the PLY header; is the file cut off?");
    }
    header.size = end + 1;
    check_counts(header, bytes.size(), name);
    return header;
}

}  // namespace kinequad
