#include "kinequad/report/draw_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace kinequad {
namespace {

/// A sign as strokes apart by blanks. A stroke is a run of points joined by straight lines, each as
/// two digits: x in 0..4, then y in 0..6 upwards from the baseline.
struct Glyph {
    char sign;
    std::string_view strokes;
};

// clang-format off
constexpr auto glyphs = std::to_array<Glyph>({
    {'A', "002640 1232"}, {'B', "00063645443303 3342413000"}, {'C', "4536160501103041"},
    {'D', "00062645412000"}, {'E', "46060040 0333"}, {'F', "460600 0333"},
    {'G', "45361605011030414323"}, {'H', "0006 4640 0343"}, {'I', "2620"}, {'J', "4641301001"},
    {'K', "0006 4602 1340"}, {'L', "060040"}, {'M', "0006234640"}, {'N', "00064046"},
    {'O', "160501103041453616"}, {'P', "00063645443303"}, {'Q', "160501103041453616 2240"},
    {'R', "00063645443303 2340"}, {'S', "453616050413334241301001"}, {'T', "0646 2620"},
    {'U', "060110304146"}, {'V', "062046"}, {'W', "0610243046"}, {'X', "0046 0640"},
    {'Y', "062346 2320"}, {'Z', "06460040"}, {'0', "160501103041453616"}, {'1', "052620 1030"},
    {'2', "05163645440040"}, {'3', "0516364544334241301001"}, {'4', "30360141"},
    {'5', "460604344341301001"}, {'6', "453616050110304142331302"}, {'7', "064610"},
    {'8', "160504133344453616 1302011030414233"}, {'9', "011030414536160504133344"}, {'.', "2021"},
    {',', "2110"}, {':', "2021 2324"}, {'-', "1333"}, {'+', "0343 2521"}, {'=', "0444 0242"},
    {'/', "0046"}, {'%', "0046 0605151606 3130404131"}, {'(', "36242230"}, {')', "16242210"},
    {'<', "450341"}, {'>', "054301"}, {'_', "0040"}, {'|', "2620"}, {'*', "1234 1432 2521"},
    {'#', "1016 3036 0242 0444"}, {'\'', "2624"},
});
// clang-format on

constexpr double glyph_width = 4;
constexpr double glyph_height = 6;
constexpr double glyph_gap = 2;
constexpr double small_capital = 0.76;

struct Segment {
    Vector2 from;
    Vector2 to;
};

struct Laid {
    std::vector<Segment> segments;  ///< pixels, y down from the baseline
    double width = 0;
};

Laid lay_out(std::string_view text, double height) {
    Laid laid;
    double pen = 0;
    for (const char sign : text) {
        const auto byte = static_cast<unsigned char>(sign);
        const char capital = static_cast<char>(std::toupper(byte));
        const double scale = height / glyph_height * (std::islower(byte) ? small_capital : 1);
        // Narrow signs keep less room, or words fall apart.
        const bool narrow = std::string_view("I1.,:|'").find(capital) != std::string_view::npos;
        const double shift = narrow ? 1.2 : 0;
        const auto glyph = std::find_if(glyphs.begin(), glyphs.end(),
                                        [&](const Glyph& g) { return g.sign == capital; });
        if (glyph != glyphs.end()) {
            const std::string_view strokes = glyph->strokes;
            const auto point = [&](std::size_t at) {
                return Vector2(pen + scale * (strokes[at] - '0' - shift),
                               -scale * (strokes[at + 1] - '0'));
            };
            for (std::size_t at = 0; at + 3 < strokes.size();) {
                if (strokes[at + 2] == ' ') {
                    at += 3;
                } else {
                    laid.segments.push_back({point(at), point(at + 2)});
                    at += 2;
                }
            }
        }
        pen += scale * (glyph_width - 2 * shift + glyph_gap);
        laid.width = pen - scale * glyph_gap;
    }
    return laid;
}

double distance_to(const Segment& segment, const Vector2& p) {
    const Vector2 u = segment.to - segment.from;
    const double squared = u.squaredNorm();
    const double t = squared > 0 ? std::clamp((p - segment.from).dot(u) / squared, 0.0, 1.0) : 0;
    return (p - segment.from - t * u).norm();
}

}  // namespace

double text_width(std::string_view text, double height) { return lay_out(text, height).width; }

Image draw_text(Image image, std::string_view text, double left, double baseline, double height,
                const Color& color) {
    const Laid laid = lay_out(text, height);
    const double half_stroke = std::max(0.5, 0.065 * height);
    const auto clipped = [](double value, int limit) {
        return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(limit)));
    };
    for (int y = clipped(baseline - height - 3, image.height);
         y < clipped(baseline + 4, image.height); ++y) {
        for (int x = clipped(left - 3, image.width);
             x < clipped(left + laid.width + 4, image.width); ++x) {
            const Vector2 p(x + 0.5 - left, y + 0.5 - baseline);
            double nearest = std::numeric_limits<double>::infinity();
            for (const Segment& segment : laid.segments) {
                nearest = std::min(nearest, distance_to(segment, p));
            }
            const double ink = std::clamp(half_stroke + 0.5 - nearest, 0.0, 1.0);
            if (ink == 0) continue;
            for (int c = 0; c < 3; ++c) {
                auto& byte = image.rgb[image.offset(x, y) + static_cast<std::size_t>(c)];
                byte = static_cast<std::uint8_t>(
                    std::lround((1 - ink) * byte + ink * 255 * std::clamp(color[c], 0.0, 1.0)));
            }
        }
    }
    return image;
}

}  // namespace kinequad
