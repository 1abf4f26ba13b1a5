#pragma once

#include <Eigen/Core>
#include <cmath>
#include <compare>
#include <concepts>

namespace kinequad {

/// The unevaluated sum of two doubles, some 31 decimal digits [Dekker 1971]. A conformal map
/// shrinks tails and limbs to 1e-20 of the sphere, where plain doubles have no digit left for their
/// shape.
class DoubleDouble {
public:
    DoubleDouble() = default;
    DoubleDouble(double x) : high_(x) {}  // NOLINT: doubles mix freely with their sums
    template <std::integral Integer>
    DoubleDouble(Integer x) : high_(static_cast<double>(x)) {}  // NOLINT
    explicit operator double() const { return high_; }

    friend DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
        const DoubleDouble s = sum(a.high_, b.high_);
        const DoubleDouble t = sum(a.low_, b.low_);
        const DoubleDouble u = quick_sum(s.high_, s.low_ + t.high_);
        return quick_sum(u.high_, u.low_ + t.low_);
    }
    friend DoubleDouble operator-(const DoubleDouble& a) { return {-a.high_, -a.low_}; }
    friend DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + -b; }
    friend DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
        const DoubleDouble p = product(a.high_, b.high_);
        return quick_sum(p.high_, p.low_ + (a.high_ * b.low_ + a.low_ * b.high_));
    }
    friend DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
        const double first = a.high_ / b.high_;
        const DoubleDouble rest = a - b * first;
        const double second = rest.high_ / b.high_;
        const double third = (rest - b * second).high_ / b.high_;
        return quick_sum(first, second) + DoubleDouble(third);
    }
    DoubleDouble& operator+=(const DoubleDouble& b) { return *this = *this + b; }
    DoubleDouble& operator-=(const DoubleDouble& b) { return *this = *this - b; }
    DoubleDouble& operator*=(const DoubleDouble& b) { return *this = *this * b; }
    DoubleDouble& operator/=(const DoubleDouble& b) { return *this = *this / b; }

    friend bool operator==(const DoubleDouble& a, const DoubleDouble& b) = default;
    friend std::partial_ordering operator<=>(const DoubleDouble& a, const DoubleDouble& b) {
        const std::partial_ordering order = a.high_ <=> b.high_;
        return order != 0 ? order : a.low_ <=> b.low_;
    }
    friend DoubleDouble abs(const DoubleDouble& a) { return a.high_ < 0 ? -a : a; }
    /// Newton's step from the square root in doubles; 0 below 0.
    friend DoubleDouble sqrt(const DoubleDouble& a) {
        if (!(a.high_ > 0)) return 0.0;
        const double root = std::sqrt(a.high_);
        const double rest = (a - product(root, root)).high_ / (2 * root);
        return quick_sum(root, rest);
    }
    friend bool isfinite(const DoubleDouble& a) { return std::isfinite(a.high_); }

private:
    DoubleDouble(double high, double low) : high_(high), low_(low) {}

    /// Exact sum of two doubles.
    static DoubleDouble sum(double a, double b) {
        const double s = a + b;
        const double other = s - a;
        return {s, (a - (s - other)) + (b - other)};
    }
    /// Exact sum where |a| >= |b|.
    static DoubleDouble quick_sum(double a, double b) {
        const double s = a + b;
        return {s, b - (s - a)};
    }
    /// Exact product of two doubles, by halves of 26 bits.
    static DoubleDouble product(double a, double b) {
        const double p = a * b;
        const double a_high = upper_half(a);
        const double b_high = upper_half(b);
        const double a_low = a - a_high;
        const double b_low = b - b_high;
        return {p, ((a_high * b_high - p) + a_high * b_low + a_low * b_high) + a_low * b_low};
    }
    static double upper_half(double a) {
        const double shifted = 134217729.0 * a;
        return shifted - (shifted - a);
    }

    double high_ = 0;
    double low_ = 0;
};

}  // namespace kinequad

namespace Eigen {

template <>
struct NumTraits<kinequad::DoubleDouble> : GenericNumTraits<kinequad::DoubleDouble> {
    using Real = kinequad::DoubleDouble;
    using NonInteger = kinequad::DoubleDouble;
    using Literal = double;
    enum {
        IsComplex = 0,
        IsInteger = 0,
        IsSigned = 1,
        RequireInitialization = 1,
        ReadCost = 2,
        AddCost = 20,
        MulCost = 25
    };
    static Real epsilon() { return 1e-31; }
    static Real dummy_precision() { return 1e-28; }
    static Real highest() { return NumTraits<double>::highest(); }
    static Real lowest() { return NumTraits<double>::lowest(); }
    static int digits10() { return 31; }
};

}  // namespace Eigen
