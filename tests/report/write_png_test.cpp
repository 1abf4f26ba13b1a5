#include "kinequad/report/write_png.h"

#include <gtest/gtest.h>
#include <png.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "kinequad/core/error.h"

namespace kinequad {
namespace {

Image gradient(int width, int height) {
    Image image{width, height, {}};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            for (const int value : {x * 7, y * 11, x * y}) {
                image.rgb.push_back(static_cast<std::uint8_t>(value % 256));
            }
        }
    }
    return image;
}

TEST(EncodePng, DecodesToTheSameImage) {
    const Image image = gradient(37, 21);
    const std::string bytes = encode_png(image);
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    ASSERT_NE(png_image_begin_read_from_memory(&header, bytes.data(), bytes.size()), 0);
    EXPECT_EQ(header.width, 37U);
    EXPECT_EQ(header.height, 21U);
    header.format = PNG_FORMAT_RGB;
    std::vector<std::uint8_t> decoded(image.rgb.size());
    ASSERT_NE(png_image_finish_read(&header, nullptr, decoded.data(), 0, nullptr), 0);
    EXPECT_EQ(decoded, image.rgb);
}

TEST(WritePng, WritesTheEncodedBytesAndLeavesNothingBeside) {
    const auto folder = std::filesystem::path(testing::TempDir()) / "kinequad_write_png";
    std::filesystem::create_directories(folder);
    const Image image = gradient(5, 4);
    write_png(folder / "a.png", image);
    std::ifstream file(folder / "a.png", std::ios::binary);
    const std::string read((std::istreambuf_iterator<char>(file)), {});
    EXPECT_EQ(read, encode_png(image));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
    std::filesystem::remove_all(folder);
}

TEST(WritePng, NamesTheFileThatCannotBeWritten) {
    try {
        write_png("/dev/null/a.png", gradient(2, 2));
        FAIL();
    } catch (const InputError& error) {
        EXPECT_EQ(error.fault(), InputFault::file);
        EXPECT_NE(std::string(error.what()).find("/dev/null"), std::string::npos);
    }
}

}  // namespace
}  // namespace kinequad
