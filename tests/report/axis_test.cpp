#include "kinequad/report/axis.h"

#include <gtest/gtest.h>

#include <random>

namespace kinequad {
namespace {

TEST(Axis, TicksAreRoundNumbersAndReachBothEnds) {
    const Axis axis = value_axis(5.9, 10.7, 6);
    EXPECT_EQ(axis.low, 5);
    EXPECT_EQ(axis.high, 11);
    EXPECT_EQ(axis.ticks, (std::vector<double>{5, 6, 7, 8, 9, 10, 11}));
    EXPECT_EQ(axis.decimals, 0);
    EXPECT_EQ(axis.label(7), "7");
}

TEST(Axis, BeginsAtZeroForValuesThatSpreadOverIt) {
    EXPECT_EQ(value_axis(0.3, 0.8, 6).low, 0);
    EXPECT_GT(value_axis(0.7, 0.8, 6).low, 0);
    EXPECT_LT(value_axis(-0.3, 0.8, 6).low, -0.29);
}

TEST(Axis, LabelsHaveTheDecimalsOfTheirStep) {
    const Axis axis = value_axis(0.0312, 0.0379, 6);
    EXPECT_EQ(axis.decimals, 3);
    EXPECT_EQ(axis.label(axis.ticks.front()), "0.030");
    EXPECT_EQ(value_axis(-1, 1, 3).label(-1),
              "\xE2\x88\x92"
              "1");
    EXPECT_EQ(value_axis(-1, 1, 3).label(-0.0), "0");
}

TEST(Axis, HoldsAnyValues) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> exponent(-9, 9);
    for (int i = 0; i < 1000; ++i) {
        const double a = (i % 2 == 0 ? 1 : -1) * std::pow(10, exponent(random));
        const double b = a + (i % 5 == 0 ? 0 : std::pow(10, exponent(random)));
        const Axis axis = value_axis(a, b, 6);
        ASSERT_LE(axis.low, a + 1e-5 * std::abs(axis.high - axis.low));
        ASSERT_GE(axis.high, b - 1e-5 * std::abs(axis.high - axis.low));
        ASSERT_GE(axis.ticks.size(), 2U) << a << " " << b;
        ASSERT_LE(axis.ticks.size(), 16U) << a << " " << b;
    }
}

TEST(Axis, FramesAreWholeNumbers) {
    EXPECT_EQ(frame_axis(0, 174, 6).ticks, (std::vector<double>{0, 50, 100, 150}));
    EXPECT_EQ(frame_axis(0, 3, 6).ticks, (std::vector<double>{0, 1, 2, 3}));
    EXPECT_EQ(frame_axis(0, 0, 6).ticks, (std::vector<double>{0}));
}

}  // namespace
}  // namespace kinequad
