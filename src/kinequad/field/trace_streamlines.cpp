#include "kinequad/field/trace_streamlines.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>

#include "kinequad/core/index.h"

namespace kinequad {
namespace {

/// Where a straight line leaves a triangle.
struct Exit {
    SurfacePoint point;  ///< in the triangle that is left
    double length = 0;   ///< of the way there
    int half_edge = -1;  ///< that is crossed
};

Exit leave_triangle(const Eigen::Matrix<double, 2, 3>& corners, const SurfacePoint& start,
                    double angle) {
    Eigen::Matrix2d sides;
    sides << corners.col(1) - corners.col(0), corners.col(2) - corners.col(0);
    const Vector2 st = sides.inverse() * Vector2(std::cos(angle), std::sin(angle));
    const Vector3 change(-st[0] - st[1], st[0], st[1]);
    Exit exit;
    exit.length = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
        if (!(change[k] < 0)) continue;
        const double until = std::max(0.0, start.barycentric[k]) / -change[k];
        if (until >= exit.length) continue;
        exit.length = until;
        exit.half_edge = 3 * start.triangle + (k + 1) % 3;
    }
    if (exit.half_edge < 0) return exit;
    const Vector3 end = (start.barycentric + exit.length * change).cwiseMax(0);
    exit.point = {start.triangle, end / end.sum()};
    return exit;
}

/// The same point of an edge in the triangle across half-edge `h`.
SurfacePoint across(const Topology& topology, const SurfacePoint& point, int h) {
    const int other = topology.twin[at(h)];
    SurfacePoint next{other / 3, Vector3::Zero()};
    next.barycentric[other % 3] = point.barycentric[Topology::next(h) % 3];
    next.barycentric[Topology::next(other) % 3] = point.barycentric[h % 3];
    next.barycentric /= next.barycentric.sum();
    return next;
}

class Tracer {
public:
    Tracer(const Topology& topology, const IntrinsicMetric& metric, const CrossField& field)
        : topology_(topology),
          metric_(metric),
          field_(field),
          is_passed_(at(topology.triangle_count), 0) {}

    /// No line has crossed a triangle that shares a vertex with `t`.
    bool is_open(int t) const {
        for (int k = 0; k < 3; ++k) {
            const int start = 3 * t + k;
            for (int h = start; h >= 0;) {
                if (is_passed_[at(h / 3)]) return false;
                h = topology_.rotate_counter_clockwise(h);
                if (h == start) break;
            }
        }
        return true;
    }

    /// Both ways from `start`, along its arm at `angle`.
    std::vector<SurfacePoint> line(const SurfacePoint& start, double angle, double length) {
        std::vector<SurfacePoint> points = way(start, angle + std::numbers::pi, length);
        std::reverse(points.begin(), points.end());
        points.push_back(start);
        const std::vector<SurfacePoint> ahead = way(start, angle, length);
        points.insert(points.end(), ahead.begin(), ahead.end());
        return points;
    }

private:
    std::vector<SurfacePoint> way(SurfacePoint here, double angle, double length) {
        constexpr int most_crossings = 1000;
        std::vector<SurfacePoint> points;
        for (int crossing = 0; crossing < most_crossings && length > 0; ++crossing) {
            is_passed_[at(here.triangle)] = 1;
            const auto sides = side_lengths(topology_, metric_, here.triangle);
            if (!(triangle_area(sides) > 0)) break;
            const Exit exit = leave_triangle(lay_out_triangle(sides), here, angle);
            if (exit.half_edge < 0) break;
            points.push_back(exit.point);
            length -= exit.length;
            if (topology_.twin[at(exit.half_edge)] < 0) break;
            here = across(topology_, exit.point, exit.half_edge);
            const double carried = angle + frame_rotation(topology_, metric_, exit.half_edge);
            const double arm = field_.angle[here.triangle];
            angle =
                arm + std::numbers::pi / 2 * std::round((carried - arm) / (std::numbers::pi / 2));
        }
        return points;
    }

    const Topology& topology_;
    const IntrinsicMetric& metric_;
    const CrossField& field_;
    std::vector<char> is_passed_;
};

/// 0 to `count - 1` in steps of about the golden section, which spreads them.
std::vector<int> spread_order(int count) {
    auto step = static_cast<std::int64_t>(0.618 * count) | 1;
    while (std::gcd(step, static_cast<std::int64_t>(count)) != 1) step += 2;
    std::vector<int> order;
    order.reserve(at(count));
    for (std::int64_t i = 0; i < count; ++i) order.push_back(static_cast<int>(i * step % count));
    return order;
}

}  // namespace

std::vector<std::vector<SurfacePoint>> trace_streamlines(const Topology& topology,
                                                         const IntrinsicMetric& metric,
                                                         const CrossField& field, double length) {
    Tracer tracer(topology, metric, field);
    std::vector<std::vector<SurfacePoint>> lines;
    for (const int t : spread_order(topology.triangle_count)) {
        if (!tracer.is_open(t)) continue;
        const SurfacePoint middle{t, Vector3::Constant(1.0 / 3)};
        for (const double turn : {0.0, std::numbers::pi / 2}) {
            lines.push_back(tracer.line(middle, field.angle[t] + turn, length));
        }
    }
    return lines;
}

}  // namespace kinequad
