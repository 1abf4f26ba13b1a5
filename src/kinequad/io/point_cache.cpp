#include "kinequad/io/point_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "kinequad/core/error.h"
#include "kinequad/io/byte_order.h"
#include "kinequad/io/files.h"

namespace kinequad {
namespace {

constexpr std::string_view pc2_magic("POINTCACHE2\0", 12);
constexpr std::uint64_t pc2_head_size = 32;
constexpr std::uint64_t mdd_head_size = 8;
constexpr std::uint64_t point_size = 12;

std::int32_t integer_at(std::string_view head, std::size_t offset, std::endian order) {
    return load_number<std::int32_t>(head.data() + offset, order);
}

/// Throws unless the file is exactly `head_size` bytes and `samples` times `points` points and
/// `extra` bytes.
void check_counts(int points, int samples, std::uint64_t head_size, std::uint64_t extra,
                  std::uint64_t file_size, const std::string& name) {
    if (points < 1 || samples < 1) {
        refuse_file(name, fmt::format("its header says {} samples of {} points; write it again",
                                      samples, points));
    }
    // Divided, since the product of the counts need not fit 64 bits.
    const std::uint64_t sample_size = static_cast<std::uint64_t>(points) * point_size + extra;
    const std::uint64_t available = file_size - head_size;
    const bool fits = available % sample_size == 0 &&
                      available / sample_size == static_cast<std::uint64_t>(samples);
    if (!fits) {
        refuse_file(
            name,
            fmt::format("its header says {} samples of {} points, which does not fit a file of {} "
                        "bytes; is it cut off?",
                        samples, points, file_size));
    }
}

PointCacheLayout parse_pc2(std::string_view head, std::uint64_t file_size,
                           const std::string& name) {
    if (!head.starts_with(pc2_magic.substr(0, std::min(head.size(), pc2_magic.size())))) {
        refuse_file(name, "is no PC2 point cache: it does not begin with POINTCACHE2");
    }
    if (head.size() < pc2_head_size) refuse_file(name, "ends within its header; is it cut off?");
    const std::int32_t version = integer_at(head, 12, std::endian::little);
    if (version != 1)
        refuse_file(name, fmt::format("is a PC2 of version {}; only version 1 is known", version));
    PointCacheLayout layout;
    layout.points = integer_at(head, 16, std::endian::little);
    layout.samples = integer_at(head, 28, std::endian::little);
    layout.data_begin = pc2_head_size;
    check_counts(layout.points, layout.samples, pc2_head_size, 0, file_size, name);
    return layout;
}

PointCacheLayout parse_mdd(std::string_view head, std::uint64_t file_size,
                           const std::string& name) {
    if (head.size() < mdd_head_size) refuse_file(name, "ends within its header; is it cut off?");
    PointCacheLayout layout;
    layout.samples = integer_at(head, 0, std::endian::big);
    layout.points = integer_at(head, 4, std::endian::big);
    layout.is_big_endian = true;
    // Every frame has its time, four bytes, before the first sample.
    check_counts(layout.points, layout.samples, mdd_head_size, 4, file_size, name);
    layout.data_begin = mdd_head_size + 4 * static_cast<std::uint64_t>(layout.samples);
    return layout;
}

PointCacheLayout read_layout(const RandomAccessFile& file) {
    std::array<char, point_cache_head_size> head{};
    const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(head.size(), file.size()));
    file.read(0, std::span(head).first(size));
    return parse_point_cache_layout({head.data(), size}, file.size(), extension_of(file.path()),
                                    file.path().string());
}

}  // namespace

PointCacheLayout parse_point_cache_layout(std::string_view head, std::uint64_t file_size,
                                          const std::string& extension, const std::string& name) {
    if (file_size == 0) refuse_file(name, "is empty; write it again");
    return extension == ".mdd" ? parse_mdd(head, file_size, name)
                               : parse_pc2(head, file_size, name);
}

PointCache::PointCache(const std::filesystem::path& path)
    : file_(path), layout_(read_layout(file_)) {}

Positions PointCache::read_sample(int sample) const {
    require(0 <= sample && sample < layout_.samples, InputFault::usage,
            "a point cache was asked for a sample that it does not have");
    const auto size = static_cast<std::size_t>(layout_.points) * point_size;
    std::vector<char> bytes(size);
    file_.read(layout_.data_begin + static_cast<std::uint64_t>(sample) * size, bytes);
    const std::endian order = layout_.is_big_endian ? std::endian::big : std::endian::little;
    Positions V(layout_.points, 3);
    for (Eigen::Index k = 0; k < V.size(); ++k) {
        V.data()[k] = load_number<float>(bytes.data() + 4 * k, order);
    }
    if (!V.allFinite()) {
        Eigen::Index bad = 0;
        while (V.row(bad).allFinite()) ++bad;
        throw InputError(InputFault::mesh,
                         fmt::format("{}: vertex {} is not finite in sample {}; give it a position",
                                     name(), bad, sample));
    }
    return V;
}

}  // namespace kinequad
