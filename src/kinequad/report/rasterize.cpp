#include "kinequad/report/rasterize.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinequad/core/index.h"

namespace kinequad::report_detail {
namespace {

/// Samples this far outside of a side, in pixels, still count as inside, so that no crack opens
/// between two triangles that share it. Depth decides between the two.
constexpr float side_tolerance = 1e-4F;
/// No sample is farther from the centre of its pixel, in pixels.
constexpr double sample_reach = 0.7072;

struct Box {
    double low_x, low_y, high_x, high_y;
};

Box box_of(const ScreenScene& scene, const ScreenTriangle& triangle) {
    const auto& a = scene.vertices[at(triangle.vertex[0])];
    const auto& b = scene.vertices[at(triangle.vertex[1])];
    const auto& c = scene.vertices[at(triangle.vertex[2])];
    return {std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::max({a.x, b.x, c.x}),
            std::max({a.y, b.y, c.y})};
}

Box box_of(const ScreenStroke& stroke) {
    const double r = stroke.radius;
    return {std::min(stroke.from.x, stroke.to.x) - r, std::min(stroke.from.y, stroke.to.y) - r,
            std::max(stroke.from.x, stroke.to.x) + r, std::max(stroke.from.y, stroke.to.y) + r};
}

/// Cells of a row of `count` cells of `size` that [low, high] meets; empty where first > last.
struct Range {
    int first, last;
};
Range cells_between(double low, double high, double size, int count) {
    if (!(high >= 0) || !(low <= size * count)) return {0, -1};
    const double last = count - 1;
    return {static_cast<int>(std::clamp(std::floor(low / size), 0.0, last)),
            static_cast<int>(std::clamp(std::floor(high / size), 0.0, last))};
}

template <class Boxes>
void sort_boxes(std::size_t count, const TileLists& tiles, const Boxes& box,
                std::vector<std::size_t>& begin, std::vector<int>& list) {
    const std::size_t tile_count =
        static_cast<std::size_t>(tiles.columns) * static_cast<std::size_t>(tiles.rows);
    begin.assign(tile_count + 1, 0);
    const auto for_tiles = [&](std::size_t i, const auto& visit) {
        const Box b = box(i);
        const Range x = cells_between(b.low_x, b.high_x, tiles.size, tiles.columns);
        const Range y = cells_between(b.low_y, b.high_y, tiles.size, tiles.rows);
        for (int row = y.first; row <= y.last; ++row) {
            for (int column = x.first; column <= x.last; ++column) {
                visit(static_cast<std::size_t>(row) * static_cast<std::size_t>(tiles.columns) +
                      static_cast<std::size_t>(column));
            }
        }
    };
    for (std::size_t i = 0; i < count; ++i) {
        for_tiles(i, [&](std::size_t tile) { ++begin[tile + 1]; });
    }
    for (std::size_t tile = 0; tile < tile_count; ++tile) begin[tile + 1] += begin[tile];
    list.resize(begin[tile_count]);
    std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
    for (std::size_t i = 0; i < count; ++i) {
        for_tiles(i, [&](std::size_t tile) { list[next[tile]++] = static_cast<int>(i); });
    }
}

/// A linear function of the picture: value at the origin of pixels and its slope along x and y.
struct Plane {
    double value, x, y;
    double at(double px, double py) const { return value + x * px + y * py; }
};

/// What a tile's samples hold: nearest depth and what it belongs to.
struct Samples {
    std::vector<float> depth;
    std::vector<Hit> hit;
};

struct PixelRange {
    int first_x, last_x, first_y, last_y;  ///< in the picture
    int origin_x, origin_y, stride;        ///< of the tile

    std::size_t sample(int x, int y) const {
        return static_cast<std::size_t>((y - origin_y) * stride + (x - origin_x)) * sample_count;
    }
};

PixelRange clip(const Box& box, const ScreenScene& scene, const TileLists& tiles, int tile) {
    PixelRange range{};
    range.origin_x = tile % tiles.columns * tiles.size;
    range.origin_y = tile / tiles.columns * tiles.size;
    range.stride = tiles.size;
    const Range x = cells_between(box.low_x, box.high_x, 1, scene.width);
    const Range y = cells_between(box.low_y, box.high_y, 1, scene.height);
    range.first_x = std::max(x.first, range.origin_x);
    range.last_x = std::min(x.last, range.origin_x + tiles.size - 1);
    range.first_y = std::max(y.first, range.origin_y);
    range.last_y = std::min(y.last, range.origin_y + tiles.size - 1);
    return range;
}

float smaller(float a, float b) { return a < b ? a : b; }
float larger(float a, float b) { return a > b ? a : b; }

void draw_triangle(const ScreenScene& scene, int index, const PixelRange& range, Samples& samples) {
    const auto& triangle = scene.triangles[at(index)];
    std::array<ScreenVertex, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) {
        corner[k] = scene.vertices[at(triangle.vertex[k])];
    }
    // Signed distance to each side, positive inside, in pixels.
    std::array<Plane, 3> side{};
    Plane depth{0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
        const ScreenVertex& a = corner[k];
        const ScreenVertex& b = corner[(k + 1) % 3];
        const ScreenVertex& opposite = corner[(k + 2) % 3];
        const double length = std::hypot(b.x - a.x, b.y - a.y);
        const double nx = -(b.y - a.y) / length;
        const double ny = (b.x - a.x) / length;
        side[k] = {-(nx * a.x + ny * a.y), nx, ny};
        const double height = side[k].at(opposite.x, opposite.y);
        depth.value += side[k].value / height * opposite.depth;
        depth.x += nx / height * opposite.depth;
        depth.y += ny / height * opposite.depth;
    }
    const auto least =
        static_cast<float>(std::min({corner[0].depth, corner[1].depth, corner[2].depth}));
    const auto most =
        static_cast<float>(std::max({corner[0].depth, corner[1].depth, corner[2].depth}));
    const SamplePattern& pattern = sample_pattern();
    const auto half_line = static_cast<float>(scene.half_line);
    // A side that is no edge of a polygon is too far away to be drawn.
    std::array<float, 3> no_edge{};
    std::array<float, 3> slope_x{};
    std::array<float, 3> slope_y{};
    for (std::size_t k = 0; k < 3; ++k) {
        no_edge[k] = triangle.is_edge[k] ? 0.0F : 1e30F;
        slope_x[k] = static_cast<float>(side[k].x);
        slope_y[k] = static_cast<float>(side[k].y);
    }
    const auto depth_x = static_cast<float>(depth.x);
    const auto depth_y = static_cast<float>(depth.y);
    for (int y = range.first_y; y <= range.last_y; ++y) {
        for (int x = range.first_x; x <= range.last_x; ++x) {
            std::array<float, 3> center{};
            bool outside = false;
            for (std::size_t k = 0; k < 3; ++k) {
                const double d = side[k].at(x + 0.5, y + 0.5);
                outside = outside || d < -sample_reach;
                center[k] = static_cast<float>(d);
            }
            if (outside) continue;
            const auto center_depth = static_cast<float>(depth.at(x + 0.5, y + 0.5));
            const std::size_t first = range.sample(x, y);
            // Plain loops over the samples, one quantity each, for the compiler to do four at once.
            std::array<float, sample_count> inside;
            std::array<float, sample_count> to_line;
            std::array<float, sample_count> z;
            for (std::size_t s = 0; s < sample_count; ++s) {
                const float a = center[0] + slope_x[0] * pattern.x[s] + slope_y[0] * pattern.y[s];
                const float b = center[1] + slope_x[1] * pattern.x[s] + slope_y[1] * pattern.y[s];
                const float c = center[2] + slope_x[2] * pattern.x[s] + slope_y[2] * pattern.y[s];
                inside[s] = smaller(a, smaller(b, c));
                to_line[s] = smaller(a + no_edge[0], smaller(b + no_edge[1], c + no_edge[2]));
                const float slope = center_depth + depth_x * pattern.x[s] + depth_y * pattern.y[s];
                z[s] = smaller(larger(slope, least), most);
            }
            for (std::size_t s = 0; s < sample_count; ++s) {
                if (inside[s] < -side_tolerance || z[s] <= samples.depth[first + s]) continue;
                samples.depth[first + s] = z[s];
                const bool line = to_line[s] < half_line;
                samples.hit[first + s] = {line ? Hit::Kind::line : Hit::Kind::face, index};
            }
        }
    }
}

void draw_stroke(const ScreenStroke& stroke, int index, const PixelRange& range, Samples& samples) {
    const double ux = stroke.to.x - stroke.from.x;
    const double uy = stroke.to.y - stroke.from.y;
    const double squared_length = ux * ux + uy * uy;
    const SamplePattern& pattern = sample_pattern();
    for (int y = range.first_y; y <= range.last_y; ++y) {
        for (int x = range.first_x; x <= range.last_x; ++x) {
            const std::size_t first = range.sample(x, y);
            for (std::size_t s = 0; s < sample_count; ++s) {
                const double px = x + 0.5 + static_cast<double>(pattern.x[s]) - stroke.from.x;
                const double py = y + 0.5 + static_cast<double>(pattern.y[s]) - stroke.from.y;
                const double along =
                    squared_length > 0 ? std::clamp((px * ux + py * uy) / squared_length, 0.0, 1.0)
                                       : 0;
                const double distance = std::hypot(px - along * ux, py - along * uy);
                if (distance > stroke.radius) continue;
                const double z =
                    stroke.from.depth + along * (stroke.to.depth - stroke.from.depth) + stroke.bias;
                if (z <= static_cast<double>(samples.depth[first + s])) continue;
                samples.depth[first + s] = static_cast<float>(z);
                const bool rim = squared_length == 0 && distance > stroke.radius - 1.2;
                samples.hit[first + s] = {rim ? Hit::Kind::stroke_rim : Hit::Kind::stroke, index};
            }
        }
    }
}

}  // namespace

const SamplePattern& sample_pattern() {
    static const SamplePattern pattern = [] {
        SamplePattern made{};
        for (int i = 0; i < sample_count; ++i) {
            const int reversed = (i & 1) << 3 | (i & 2) << 1 | (i & 4) >> 1 | (i & 8) >> 3;
            made.x[at(i)] = (static_cast<float>(i) + 0.5F) / sample_count - 0.5F;
            made.y[at(i)] = (static_cast<float>(reversed) + 0.5F) / sample_count - 0.5F;
        }
        return made;
    }();
    return pattern;
}

TileLists sort_into_tiles(const ScreenScene& scene) {
    TileLists tiles;
    tiles.columns = (scene.width + tiles.size - 1) / tiles.size;
    tiles.rows = (scene.height + tiles.size - 1) / tiles.size;
    sort_boxes(
        scene.triangles.size(), tiles,
        [&](std::size_t i) { return box_of(scene, scene.triangles[i]); }, tiles.triangle_begin,
        tiles.triangles);
    sort_boxes(
        scene.strokes.size(), tiles, [&](std::size_t i) { return box_of(scene.strokes[i]); },
        tiles.stroke_begin, tiles.strokes);
    return tiles;
}

std::vector<Hit> rasterize_tile(const ScreenScene& scene, const TileLists& tiles, int tile) {
    const auto size = static_cast<std::size_t>(tiles.size);
    const std::size_t count = size * size * sample_count;
    Samples samples{std::vector<float>(count, -std::numeric_limits<float>::infinity()),
                    std::vector<Hit>(count)};
    const std::size_t here = at(tile);
    for (std::size_t i = tiles.triangle_begin[here]; i < tiles.triangle_begin[here + 1]; ++i) {
        const int index = tiles.triangles[i];
        const Box box = box_of(scene, scene.triangles[at(index)]);
        draw_triangle(scene, index, clip(box, scene, tiles, tile), samples);
    }
    for (std::size_t i = tiles.stroke_begin[here]; i < tiles.stroke_begin[here + 1]; ++i) {
        const int index = tiles.strokes[i];
        const ScreenStroke& stroke = scene.strokes[at(index)];
        draw_stroke(stroke, index, clip(box_of(stroke), scene, tiles, tile), samples);
    }
    return std::move(samples.hit);
}

}  // namespace kinequad::report_detail
