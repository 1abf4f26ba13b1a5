#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "kinequad/core/error.h"
#include "kinequad/io/point_cache.h"

/// Reads arbitrary bytes as the head of both kinds of cache, in a file of a size that the first
/// bytes choose.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace kinequad;
    if (size < 8) return 0;
    std::uint64_t extra = 0;
    for (std::size_t k = 0; k < 8; ++k) extra = extra << 8U | data[k];
    const std::string_view bytes(reinterpret_cast<const char*>(data) + 8, size - 8);
    const std::uint64_t file_size = bytes.size() + extra % (std::uint64_t{1} << 62U);
    for (const std::string extension : {".pc2", ".mdd"}) {
        try {
            const PointCacheLayout layout = parse_point_cache_layout(
                bytes.substr(0, point_cache_head_size), file_size, extension, "fuzz");
            const std::uint64_t sample =
                std::uint64_t{12} * static_cast<std::uint64_t>(layout.points);
            const std::uint64_t data_size = file_size - layout.data_begin;
            if (layout.data_begin > file_size || data_size % sample != 0 ||
                data_size / sample != static_cast<std::uint64_t>(layout.samples)) {
                std::abort();
            }
        } catch (const InputError&) {
        }
    }
    return 0;
}
