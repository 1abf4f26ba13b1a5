#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kinequad/core/context.h"
#include "kinequad/core/types.h"

namespace kinequad::report_detail {

/// Samples of a pixel. Their offsets from its centre are distinct along both axes, so that a nearly
/// horizontal or vertical line passes through sixteen shades.
inline constexpr int sample_count = 16;
struct SamplePattern {
    std::array<float, sample_count> x;
    std::array<float, sample_count> y;
};
const SamplePattern& sample_pattern();

/// A vertex in the picture: pixels right and down, and depth in pixels, larger is nearer.
struct ScreenVertex {
    double x = 0;
    double y = 0;
    double depth = 0;
};

/// A triangle ready for the picture, its corners counter-clockwise in pixels (y down).
struct ScreenTriangle {
    std::array<int, 3> vertex;
    std::array<bool, 3> is_edge;  ///< whether the side from corner k to k + 1 is a polygon's
    int polygon = 0;
    bool seen_from_behind = false;
    float line_opacity = 1;
};

/// A disc or a thick line in front of the surface.
struct ScreenStroke {
    ScreenVertex from;
    ScreenVertex to;
    double radius = 1;  ///< pixels
    double bias = 0;    ///< pixels by which the surface has to be nearer to hide it
    Vector3 color;
};

/// What a sample shows.
struct Hit {
    enum class Kind : std::uint8_t { background, face, line, stroke, stroke_rim };
    Kind kind = Kind::background;
    int index = 0;  ///< triangle or stroke
};

struct ScreenScene {
    int width = 0;
    int height = 0;
    double half_line = 0.5;  ///< pixels
    std::vector<ScreenVertex> vertices;
    std::vector<ScreenTriangle> triangles;
    std::vector<ScreenStroke> strokes;
};

/// Index of each primitive in the tiles that its box touches, in ascending order a tile.
struct TileLists {
    int size = 32;  ///< pixels
    int columns = 0;
    int rows = 0;
    std::vector<std::size_t> triangle_begin;  ///< tiles + 1
    std::vector<int> triangles;
    std::vector<std::size_t> stroke_begin;
    std::vector<int> strokes;
};
TileLists sort_into_tiles(const ScreenScene& scene);

/// Nearest primitive at each sample of tile `tile`: `size * size * sample_count` hits, pixels in
/// rows.
std::vector<Hit> rasterize_tile(const ScreenScene& scene, const TileLists& tiles, int tile);

}  // namespace kinequad::report_detail
