#pragma once

#include <string>
#include <vector>

namespace kinequad {

/// The range of an axis and where it is labelled.
struct Axis {
    double low = 0;
    double high = 1;
    std::vector<double> ticks;  ///< multiples of 1, 2 or 5 times a power of ten, in [low, high]
    int decimals = 0;           ///< that the ticks need

    /// Place of `value` along the axis: 0 at `low`, 1 at `high`.
    double place(double value) const { return (value - low) / (high - low); }
    /// The label of a tick.
    std::string label(double tick) const;
};

/// A vertical axis for values between `low` and `high`, with about `count` ticks, the outer two at
/// its ends. It begins at 0 where the values are positive and the smallest is below half of the
/// largest.
Axis value_axis(double low, double high, int count);

/// A horizontal axis for frames `first` to `last`, with ticks at whole numbers inside.
Axis frame_axis(int first, int last, int count);

}  // namespace kinequad
