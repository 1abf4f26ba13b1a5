#include "kinequad/mesh/intrinsic_metric.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinequad/core/index.h"

namespace kinequad {

IntrinsicMetric metric_of(const Topology& topology, const Positions& V) {
    IntrinsicMetric metric;
    metric.edge_length.resize(topology.edge_count);
    for (int e = 0; e < topology.edge_count; ++e) {
        const int h = topology.edge_half_edge[at(e)];
        const int a = topology.origin[at(h)];
        metric.edge_length[e] = (V.row(topology.target(h)) - V.row(a)).norm();
    }
    return metric;
}

std::array<double, 3> side_lengths(const Topology& topology, const IntrinsicMetric& metric, int t) {
    std::array<double, 3> sides{};
    for (std::size_t k = 0; k < 3; ++k) {
        sides[k] = metric.edge_length[topology.edge[3 * at(t) + k]];
    }
    return sides;
}

double triangle_area(std::array<double, 3> sides) {
    std::sort(sides.begin(), sides.end());
    const auto [c, b, a] = sides;
    const double product = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c));
    return product > 0 ? 0.25 * std::sqrt(product) : 0;
}

std::array<double, 3> opposite_cotangents(const std::array<double, 3>& sides) {
    const double longest = std::max({sides[0], sides[1], sides[2]});
    const double area = std::max(triangle_area(sides), 1e-7 * longest * longest);
    std::array<double, 3> result{};
    if (!(area > 0)) return result;
    for (std::size_t k = 0; k < 3; ++k) {
        const double left = sides[(k + 1) % 3];
        const double right = sides[(k + 2) % 3];
        result[k] = (left * left + right * right - sides[k] * sides[k]) / (4 * area);
    }
    return result;
}

std::array<double, 3> corner_angles(const std::array<double, 3>& sides) {
    const double area4 = 4 * triangle_area(sides);
    std::array<double, 3> angles{};
    for (std::size_t k = 0; k < 3; ++k) {
        const double left = sides[k];
        const double right = sides[(k + 2) % 3];
        const double opposite = sides[(k + 1) % 3];
        angles[k] = std::atan2(area4, left * left + right * right - opposite * opposite);
    }
    return angles;
}

Eigen::Matrix<double, 2, 3> lay_out_triangle(const std::array<double, 3>& sides) {
    const double base = sides[0];
    Eigen::Matrix<double, 2, 3> corners = Eigen::Matrix<double, 2, 3>::Zero();
    corners(0, 1) = base;
    if (base > 0) {
        corners(0, 2) = (base * base + sides[2] * sides[2] - sides[1] * sides[1]) / (2 * base);
        corners(1, 2) = 2 * triangle_area(sides) / base;
    } else {
        corners(0, 2) = sides[2];
    }
    return corners;
}

std::array<double, 3> half_edge_directions(const std::array<double, 3>& sides) {
    const std::array<double, 3> angles = corner_angles(sides);
    return {0, std::numbers::pi - angles[1], std::numbers::pi + angles[0]};
}

Eigen::VectorXd triangle_areas(const Topology& topology, const IntrinsicMetric& metric) {
    Eigen::VectorXd areas(topology.triangle_count);
    for (int t = 0; t < topology.triangle_count; ++t) {
        areas[t] = triangle_area(side_lengths(topology, metric, t));
    }
    return areas;
}

Eigen::VectorXd angle_defects(const Topology& topology, const IntrinsicMetric& metric) {
    Eigen::VectorXd defects(topology.vertex_count);
    for (int v = 0; v < topology.vertex_count; ++v) {
        const int h = topology.vertex_half_edge[at(v)];
        defects[v] = h < 0                            ? 0
                     : topology.is_boundary_vertex(v) ? std::numbers::pi
                                                      : 2 * std::numbers::pi;
    }
    for (int t = 0; t < topology.triangle_count; ++t) {
        const std::array<double, 3> angles = corner_angles(side_lengths(topology, metric, t));
        for (std::size_t k = 0; k < 3; ++k) {
            defects[topology.origin[3 * at(t) + k]] -= angles[k];
        }
    }
    return defects;
}

double frame_rotation(const Topology& topology, const IntrinsicMetric& metric, int half_edge) {
    const int other = topology.twin[at(half_edge)];
    const auto here = half_edge_directions(side_lengths(topology, metric, half_edge / 3));
    const auto there = half_edge_directions(side_lengths(topology, metric, other / 3));
    return there[at(other % 3)] + std::numbers::pi - here[at(half_edge % 3)];
}

}  // namespace kinequad
