#pragma once

#include <filesystem>
#include <string>

#include "kinequad/report/image.h"

namespace kinequad {

/// The bytes of `image` as a PNG file, 8-bit sRGB without alpha.
std::string encode_png(const Image& image);

/// Writes `image` to `path` as PNG: the whole file appears, or none of it.
/// Throws `InputError` (file), naming `path`, where it cannot be written.
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace kinequad
