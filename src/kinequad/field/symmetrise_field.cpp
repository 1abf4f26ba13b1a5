#include "kinequad/field/symmetrise_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "kinequad/core/index.h"
#include "kinequad/core/parallel.h"

namespace kinequad {
namespace {

Complex fourth_power(double angle) { return std::polar(1.0, 4 * angle); }

/// A triangle of a 1-ring, laid out in the plane of the middle one.
struct RingTriangle {
    int triangle;
    double turn;     ///< what directions are turned by on the way to the middle, radians
    Vector2 centre;  ///< in the frame of the middle
};

class Rings {
public:
    Rings(const Topology& topology, const IntrinsicMetric& metric)
        : topology_(topology), metric_(metric) {}

    /// The triangles that share a vertex with `middle`, itself first, unfolded around its corners.
    std::vector<RingTriangle> around(int middle) const {
        const auto own = lay_out_triangle(side_lengths(topology_, metric_, middle));
        std::vector<RingTriangle> ring = {{middle, 0, own.rowwise().mean()}};
        for (int k = 0; k < 3; ++k) {
            const int h = 3 * middle + k;
            spread(ring, h, own.col(k), true);
            spread(ring, h, own.col(k), false);
        }
        return ring;
    }

private:
    /// Goes around the origin of `start`, which lies at `corner`, from triangle to triangle.
    void spread(std::vector<RingTriangle>& ring, int start, const Vector2& corner,
                bool counter_clockwise) const {
        double turn = 0;
        for (int h = start;;) {
            const int crossed = counter_clockwise ? Topology::previous(h) : h;
            const int next = counter_clockwise ? topology_.rotate_counter_clockwise(h)
                                               : topology_.rotate_clockwise(h);
            if (next < 0 || next == start) return;
            // Directions go the other way: from across the edge to here.
            turn -= frame_rotation(topology_, metric_, crossed);
            h = next;
            const bool is_known = std::any_of(ring.begin(), ring.end(), [&](const RingTriangle& r) {
                return r.triangle == h / 3;
            });
            if (is_known) {
                // Half of the ring is reached the other way around.
                if (counter_clockwise) continue;
                return;
            }
            const auto layout = lay_out_triangle(side_lengths(topology_, metric_, h / 3));
            const Vector2 from_corner = Vector2(layout.rowwise().mean()) - layout.col(h % 3);
            ring.push_back({h / 3, turn, corner + Eigen::Rotation2Dd(turn) * from_corner});
        }
    }

    const Topology& topology_;
    const IntrinsicMetric& metric_;
};

/// Largest distance between two centres of one ring, the same for all.
double largest_diameter(const std::vector<std::vector<RingTriangle>>& rings) {
    double largest = 0;
    for (const std::vector<RingTriangle>& ring : rings) {
        for (const RingTriangle& r : ring) {
            largest = std::max(largest, 2 * (r.centre - ring.front().centre).norm());
        }
    }
    return largest;
}

}  // namespace

CrossFieldTargets average_over_orbits(const Topology& topology, const IntrinsicMetric& metric,
                                      const CrossField& field, const SymmetryMap& map,
                                      double weight, const Context& context) {
    const Rings rings(topology, metric);
    std::vector<std::vector<RingTriangle>> ring_of(at(topology.triangle_count));
    parallel_for(ring_of.size(), 256, context, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) ring_of[t] = rings.around(static_cast<int>(t));
    });
    const double deviation = std::max(largest_diameter(ring_of), 1e-300);
    const auto ring_sum = [&](int middle) {
        Complex sum = 0;
        const std::vector<RingTriangle>& ring = ring_of[at(middle)];
        for (const RingTriangle& r : ring) {
            const double distance = (r.centre - ring.front().centre).norm() / deviation;
            sum +=
                std::exp(-distance * distance / 2) * fourth_power(field.angle[r.triangle] + r.turn);
        }
        return sum;
    };
    CrossFieldTargets targets{Eigen::VectorXcd::Ones(topology.triangle_count),
                              Eigen::VectorXd::Zero(topology.triangle_count)};
    for (int t = 0; t < topology.triangle_count; ++t) {
        const int image = map.centre_image[at(t)].triangle;
        // A direction x here is phi - x there, and the other way around.
        const Complex sum =
            ring_sum(t) + fourth_power(map.transport[t]) * std::conj(ring_sum(image));
        if (!(std::abs(sum) > 0)) continue;
        targets.value[t] = sum / std::abs(sum);
        targets.weight[t] = weight;
    }
    return targets;
}

SymmetryTerm symmetry_term(const SymmetryMap& map, double weight) {
    SymmetryTerm term{weight, {}, map.transport};
    term.image.reserve(map.centre_image.size());
    for (const SurfacePoint& image : map.centre_image) term.image.push_back(image.triangle);
    return term;
}

FieldSymmetry measure_field_symmetry(const Topology& topology, const IntrinsicMetric& metric,
                                     const CrossField& field, const SymmetryMap& map,
                                     const Positions& V, const Triangles& F, double distance) {
    FieldSymmetry result;
    const Eigen::VectorXd areas = triangle_areas(topology, metric);
    double area = 0;
    for (int t = 0; t < topology.triangle_count; ++t) {
        const int image = map.centre_image[at(t)].triangle;
        const Complex carried =
            fourth_power(map.transport[t]) * std::conj(fourth_power(field.angle[t]));
        const Complex there = fourth_power(field.angle[image]);
        result.mean_degrees += areas[t] * std::abs(std::arg(carried * std::conj(there))) / 4;
        area += areas[t];
    }
    result.mean_degrees *= 180 / std::numbers::pi / std::max(area, 1e-300);

    std::vector<char> is_on_curve(at(topology.vertex_count), 0);
    for (const StationaryDirection& crossed : map.stationary_direction) {
        for (int k = 0; k < 3; ++k) is_on_curve[at(F(crossed.triangle, k))] = 1;
    }
    std::vector<int> singular;
    for (int v = 0; v < topology.vertex_count; ++v) {
        if (field.index[v] != 0 && !topology.is_boundary_vertex(v)) singular.push_back(v);
    }
    for (const int v : singular) {
        if (is_on_curve[at(v)] || map.vertex_image[at(v)].triangle < 0) continue;
        ++result.singularities;
        const Vector3 image = position_of(map.vertex_image[at(v)], V, F);
        const bool has_partner = std::any_of(singular.begin(), singular.end(), [&](int w) {
            return w != v && is_on_curve[at(w)] == 0 && field.index[w] == field.index[v] &&
                   (V.row(w).transpose() - image).norm() <= distance;
        });
        result.partnered += has_partner ? 1 : 0;
    }
    return result;
}

}  // namespace kinequad
