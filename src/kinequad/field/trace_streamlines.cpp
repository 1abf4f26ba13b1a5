#include "kinequad/field/trace_streamlines.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>

#include "kinequad/core/index.h"
#include "kinequad/mesh/leave_triangle.h"

namespace kinequad {
namespace {

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
            if (!(triangle_area(side_lengths(topology_, metric_, here.triangle)) > 0)) break;
            const Vector2 arm_way(std::cos(angle), std::sin(angle));
            const TriangleExit exit = leave_triangle(topology_, metric_, here, arm_way);
            if (exit.half_edge < 0) break;
            points.push_back(point_on_way(topology_, metric_, here, arm_way, exit.share));
            length -= exit.share;
            if (topology_.twin[at(exit.half_edge)] < 0) break;
            here = point_across(topology_, points.back(), exit.half_edge);
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
