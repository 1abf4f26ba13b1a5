#include "kinequad/report/shade.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace kinequad::report_detail {
namespace {

double linear_channel(double c) {
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

/// Diffuse light that reaches a little around the terminator, which keeps shadows soft.
double wrapped(double cosine, double wrap) {
    const double reached = std::max(0.0, (cosine + wrap) / (1 + wrap));
    return reached * (0.35 + 0.65 * reached);
}

}  // namespace

Vector3 linear_from_srgb(const Vector3& color) { return color.unaryExpr(&linear_channel); }

std::uint8_t srgb_byte_from_linear(double channel) {
    // Where one byte ends and the next begins, and for parts of the range the byte at their
    // beginning: a look and a few steps are much quicker than a power.
    constexpr int parts = 4096;
    struct Table {
        std::array<double, 256> end;
        std::array<std::uint8_t, parts + 1> first;
    };
    static const Table table = [] {
        Table made{};
        for (std::size_t i = 0; i < 255; ++i) {
            made.end[i] = linear_channel((static_cast<double>(i) + 0.5) / 255);
        }
        made.end[255] = std::numeric_limits<double>::infinity();
        std::uint8_t byte = 0;
        for (std::size_t part = 0; part < made.first.size(); ++part) {
            while (made.end[byte] <= static_cast<double>(part) / parts) ++byte;
            made.first[part] = byte;
        }
        return made;
    }();
    const double light = channel > 0 ? std::min(channel, 1.0) : 0.0;  // 0 for what is no number
    std::uint8_t byte = table.first[static_cast<std::size_t>(light * parts)];
    while (table.end[byte] <= light) ++byte;
    return byte;
}

Vector3 shade(const Vector3& albedo, const Vector3& normal) {
    static const Vector3 key = Vector3(-0.50, 0.62, 0.60).normalized();
    static const Vector3 fill = Vector3(0.80, 0.10, 0.45).normalized();
    static const Vector3 half = (key + Vector3::UnitZ()).normalized();
    const Vector3 sky = Vector3(0.23, 0.24, 0.26) * (0.62 + 0.38 * normal.y());
    const Vector3 light = sky + Vector3(0.80, 0.775, 0.73) * wrapped(normal.dot(key), 0.25) +
                          Vector3(0.17, 0.20, 0.26) * wrapped(normal.dot(fill), 0.3);
    // Surfaces that turn away get darker, which draws the silhouette.
    const double facing = std::clamp(normal.z(), 0.0, 1.0);
    const double rim = 0.62 + 0.38 * (1 - (1 - facing) * (1 - facing) * (1 - facing));
    const double gloss = 0.05 * std::pow(std::max(0.0, normal.dot(half)), 24);
    return rim * albedo.cwiseProduct(light) + Vector3::Constant(gloss);
}

}  // namespace kinequad::report_detail
