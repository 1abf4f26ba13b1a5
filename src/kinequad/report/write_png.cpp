#include "kinequad/report/write_png.h"

#include <png.h>

#include <fstream>
#include <stdexcept>
#include <system_error>

#include "kinequad/core/error.h"

namespace kinequad {

std::string encode_png(const Image& image) {
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    header.width = static_cast<png_uint_32>(image.width);
    header.height = static_cast<png_uint_32>(image.height);
    header.format = PNG_FORMAT_RGB;
    header.flags = PNG_IMAGE_FLAG_FAST;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
    std::string bytes(size, '\0');
    if (png_image_write_to_memory(&header, bytes.data(), &size, 0, image.rgb.data(), 0, nullptr) ==
        0) {
        throw std::runtime_error(std::string("internal: PNG encoder: ") + header.message);
    }
    bytes.resize(size);
    return bytes;
}

void write_png(const std::filesystem::path& path, const Image& image) {
    const std::string bytes = encode_png(image);
    // Written beside and renamed, so that a stopped run leaves no half of a picture.
    std::filesystem::path beside = path;
    beside += ".part";
    std::ofstream file(beside, std::ios::binary | std::ios::trunc);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    file.close();
    std::error_code error;
    if (file) std::filesystem::rename(beside, path, error);
    if (!file || error) {
        std::error_code ignored;
        std::filesystem::remove(beside, ignored);
        throw InputError(InputFault::file,
                         path.string() + ": cannot be written; check the folder and free space");
    }
}

}  // namespace kinequad
