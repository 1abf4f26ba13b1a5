#include "kinequad/symmetry/fair_stationary_curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

#include "kinequad/symmetry/stationary_curve.h"
#include "support/shapes.h"

namespace kinequad {
namespace {

/// A unit sphere, and a map with the zero set of a height for a curve.
struct Sphere {
    TriangleMesh mesh = test::sphere(4);
    Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    IntrinsicMetric metric = metric_of(topology, mesh.V);

    SymmetryMap map(const std::function<double(const Vector3&, int)>& height_of) const {
        Eigen::VectorXd height(mesh.V.rows());
        for (int v = 0; v < static_cast<int>(height.size()); ++v) {
            height[v] = height_of(mesh.V.row(v), v);
        }
        StationaryCurve curve =
            trace_stationary_curve(topology, metric, height, topology.triangle_count, 0);
        SymmetryMap result;
        result.height = std::move(curve.height);
        result.stationary = std::move(curve.polylines);
        result.stationary_direction = std::move(curve.directions);
        return result;
    }

    /// Of the curve from the plane of y and z, at its farthest.
    double distance_from_equator(const SymmetryMap& map) const {
        double farthest = 0;
        for (const std::vector<SurfacePoint>& line : map.stationary) {
            for (const SurfacePoint& point : line) {
                farthest = std::max(farthest, std::abs(position_of(point, mesh.V, mesh.F)[0]));
            }
        }
        return farthest;
    }

    double length(const SymmetryMap& map) const {
        double sum = 0;
        for (const std::vector<SurfacePoint>& line : map.stationary) {
            for (std::size_t i = 1; i < line.size(); ++i) {
                sum += (position_of(line[i], mesh.V, mesh.F) -
                        position_of(line[i - 1], mesh.V, mesh.F))
                           .norm();
            }
        }
        return sum;
    }
};

TEST(FairStationaryCurve, TakesOutShortBends) {
    const Sphere sphere;
    // Neighbours differ, as their numbers do.
    const SymmetryMap map = sphere.map(
        [](const Vector3& p, int v) { return p[0] + 0.04 * std::sin(2.4 * v) + 0.0007; });
    ASSERT_EQ(map.stationary.size(), 1U);
    const SymmetryMap faired = fair_stationary_curve(map, sphere.topology, sphere.metric, 0.2);
    ASSERT_EQ(faired.stationary.size(), 1U);
    EXPECT_LT(sphere.distance_from_equator(faired), 0.4 * sphere.distance_from_equator(map));
    const double around = 2 * std::numbers::pi;
    EXPECT_LT(sphere.length(faired) / around - 1, 0.2 * (sphere.length(map) / around - 1));
    EXPECT_GT(faired.height.cwiseAbs().minCoeff(), 0);
}

TEST(FairStationaryCurve, LeavesAGreatCircleWhereItIs) {
    const Sphere sphere;
    const SymmetryMap map =
        sphere.map([](const Vector3& p, int) { return p[0] + (p[1] > 0 ? 1e-9 : -1e-9); });
    const SymmetryMap faired = fair_stationary_curve(map, sphere.topology, sphere.metric, 0.3);
    EXPECT_LT(sphere.distance_from_equator(faired), 1e-6);
    // Heights fall by the step's factor for the eigenvalue 2 of the sphere.
    const double factor = 1 / (1 + 2 * 0.3 * 0.3);
    EXPECT_LT((faired.height - factor * map.height).cwiseAbs().maxCoeff(), 0.01);
}

TEST(FairStationaryCurve, KeepsEveryLoop) {
    const Sphere sphere;
    // Around either pole; diffusion over the whole of `length` would leave none.
    const SymmetryMap map =
        sphere.map([](const Vector3& p, int) { return std::abs(p[2]) - 0.93001; });
    ASSERT_EQ(map.stationary.size(), 2U);
    const double tight = sphere.length(map);
    const SymmetryMap faired = fair_stationary_curve(map, sphere.topology, sphere.metric, 0.6);
    EXPECT_EQ(faired.stationary.size(), 2U);
    EXPECT_LT(sphere.length(faired), 0.95 * tight);
}

}  // namespace
}  // namespace kinequad
