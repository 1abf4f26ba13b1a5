#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "gridmap/prepared_map.h"

namespace kinequad::test {

/// Twice the area of the image of triangle `t`.
inline double determinant(const std::vector<Complex>& corners, int t) {
    return std::imag(std::conj(displacement(corners, 3 * t)) * displacement(corners, 3 * t + 1));
}

/// Every edge looks the same from both sides, up to the rotation of its transition and, on the cut,
/// a translation; boundary edges run along an axis of the chart.
inline void expect_seamless(const ChartedMesh& mesh, const std::vector<char>* is_cut,
                            const std::vector<Complex>& corners) {
    for (int h = 0; h < 3 * mesh.triangle_count(); ++h) {
        const int other = mesh.twin[at(h)];
        const Complex along = displacement(corners, h);
        if (other < 0) {
            EXPECT_NEAR(std::min(std::abs(along.real()), std::abs(along.imag())), 0, 1e-9);
            continue;
        }
        const Complex across = turn(along, mesh.rotation[at(h)]);
        EXPECT_LT(std::abs(across + displacement(corners, other)), 1e-8) << "half-edge " << h;
        if (is_cut != nullptr && !(*is_cut)[at(h)]) {
            EXPECT_LT(std::abs(corners[at(h)] - corners[at(Topology::next(other))]), 1e-8);
        }
    }
}

/// All triangles positive and every vertex with the cone angle of its index.
inline void expect_injective(const ChartedMesh& mesh, const std::vector<Complex>& corners) {
    std::vector<double> angle(at(mesh.vertex_count), 0);
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        EXPECT_GT(determinant(corners, t), 0) << "triangle " << t;
        for (int h = 3 * t; h < 3 * t + 3; ++h) {
            angle[at(mesh.origin[at(h)])] +=
                std::arg(-displacement(corners, Topology::previous(h)) / displacement(corners, h));
        }
    }
    for (int v = 0; v < mesh.vertex_count; ++v) {
        const int quarters = (mesh.is_boundary[at(v)] ? 2 : 4) - mesh.index[at(v)];
        EXPECT_NEAR(angle[at(v)], quarters * std::numbers::pi / 2, 1e-6) << "vertex " << v;
    }
}

inline double whole_distance(double x) { return std::abs(x - std::round(x)); }

}  // namespace kinequad::test
