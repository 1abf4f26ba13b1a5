#pragma once

#include <algorithm>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "kinequad/field/compute_cross_field.h"
#include "kinequad/mesh/intrinsic_metric.h"
#include "support/shapes.h"

namespace kinequad::test {

struct Surface {
    std::string name;
    Topology topology;
    IntrinsicMetric metric;
};

inline Surface surface_of(const TriangleMesh& mesh, std::string name = {}) {
    Surface surface;
    surface.name = std::move(name);
    surface.topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    surface.metric = metric_of(surface.topology, mesh.V);
    return surface;
}

/// Closed and bounded surfaces of several genera.
inline std::vector<Surface> all_surfaces() {
    return {surface_of(tetrahedron(), "tetrahedron"),
            surface_of(cube(1), "cube of 12"),
            surface_of(cube(5), "cube"),
            surface_of(sphere(3), "sphere"),
            surface_of(torus(24, 12), "torus"),
            surface_of(square(1), "two triangles"),
            surface_of(square(7), "square"),
            surface_of(cylinder(20, 9), "cylinder")};
}

/// A torus without curvature, of `around` x `along` unit squares cut along a diagonal.
inline Surface flat_torus(int around, int along) {
    Surface surface = surface_of(torus(around, along), "flat torus");
    // Half-edges 0, 1, 2 of the two triangles of a square are side, side, diagonal and diagonal,
    // side, side.
    for (int t = 0; t < surface.topology.triangle_count; ++t) {
        for (int k = 0; k < 3; ++k) {
            const bool diagonal = k == (t % 2 == 0 ? 2 : 0);
            surface.metric.edge_length[surface.topology.edge[static_cast<std::size_t>(3 * t + k)]] =
                diagonal ? std::sqrt(2.0) : 1;
        }
    }
    return surface;
}

/// Targets of random direction, and of random weight up to `largest`.
inline CrossFieldTargets random_targets(const Topology& topology, unsigned seed, double largest) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    CrossFieldTargets targets;
    targets.value.resize(topology.triangle_count);
    targets.weight.resize(topology.triangle_count);
    for (int t = 0; t < topology.triangle_count; ++t) {
        targets.value[t] = std::polar(1.0, 2 * std::numbers::pi * uniform(random));
        targets.weight[t] = largest * uniform(random);
    }
    return targets;
}

inline CrossField field_of(const Surface& surface, const CrossFieldTargets& targets = {},
                           const CrossFieldOptions& options = {}) {
    return compute_cross_field(surface.topology, surface.metric, targets, options, {});
}

inline int count_singular(const CrossField& field) {
    return static_cast<int>((field.index.array() != 0).count());
}

}  // namespace kinequad::test
