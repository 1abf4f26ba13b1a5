#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "kinequad/core/types.h"
#include "kinequad/io/files.h"

namespace kinequad {

/// Where the samples of a point cache lie in its file.
struct PointCacheLayout {
    int points = 0;                ///< points of every sample
    int samples = 0;               ///< number of samples
    std::uint64_t data_begin = 0;  ///< offset of the first sample in bytes
    bool is_big_endian = false;    ///< byte order of the coordinates, which are 32-bit floats
};

/// Bytes at the beginning of a file that `parse_point_cache_layout` needs (fewer where it is
/// shorter).
constexpr std::size_t point_cache_head_size = 32;

/// Reads the head of a PC2 (`extension` ".pc2") or MDD (".mdd") file of `file_size` bytes. `name`
/// is what messages call it. Throws `InputError` (file) where it is none, or where its counts do
/// not fit the size.
PointCacheLayout parse_point_cache_layout(std::string_view head, std::uint64_t file_size,
                                          const std::string& extension, const std::string& name);

/// An open PC2 or MDD file that hands out single samples.
class PointCache {
public:
    /// Reads the head only. Throws `InputError` (file) as `parse_point_cache_layout`.
    explicit PointCache(const std::filesystem::path& path);

    int points() const { return layout_.points; }
    int samples() const { return layout_.samples; }
    /// Positions (points x 3) of sample `sample`, 0 <= sample < samples(). Safe to call from
    /// several threads. Throws `InputError` (file) where it cannot be read, (mesh) where a
    /// coordinate is not finite.
    Positions read_sample(int sample) const;
    std::string name() const { return file_.path().string(); }

private:
    RandomAccessFile file_;
    PointCacheLayout layout_;
};

}  // namespace kinequad
