#include "kinequad/report/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kinequad {
namespace {

/// The least of 1, 2 and 5 times a power of ten that is at least `wanted`.
double nice_step(double wanted) {
    const double power = std::pow(10.0, std::floor(std::log10(wanted)));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (factor * power >= wanted * (1 - 1e-9)) return factor * power;
    }
    return 10 * power;
}

void set_ticks(double step, double first, double last, Axis& axis) {
    // Counted in whole steps, so that no rounding adds up.
    const auto begin = static_cast<long long>(std::ceil(first / step - 1e-6));
    const auto end = static_cast<long long>(std::floor(last / step + 1e-6));
    for (long long i = begin; i <= end; ++i) axis.ticks.push_back(static_cast<double>(i) * step);
    axis.decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
}

}  // namespace

std::string Axis::label(double tick) const {
    std::string text = fmt::format("{:.{}f}", tick == 0 ? 0.0 : tick, decimals);
    // A minus as wide as a digit.
    if (text.front() == '-') text.replace(0, 1, "\xE2\x88\x92");
    return text;
}

Axis value_axis(double low, double high, int count) {
    Axis axis;
    if (low >= 0 && low < 0.5 * high) low = 0;
    // Where all values are about the same, what differs is rounding.
    const double size = std::max(std::abs(low), std::abs(high));
    if (!(high - low > 1e-6 * size)) {
        const double room = size > 0 ? 0.1 * size : 1;
        low = size > 0 ? low - room : 0;
        high += room;
    }
    const double step = nice_step((high - low) / std::max(count - 1, 1));
    axis.low = step * std::floor(low / step + 1e-6);
    axis.high = step * std::ceil(high / step - 1e-6);
    set_ticks(step, axis.low, axis.high, axis);
    return axis;
}

Axis frame_axis(int first, int last, int count) {
    Axis axis;
    axis.low = first;
    axis.high = last > first ? last : first + 1;
    const double step = std::max(1.0, nice_step((axis.high - axis.low) / std::max(count, 1)));
    set_ticks(step, first, last, axis);
    axis.decimals = 0;
    return axis;
}

}  // namespace kinequad
