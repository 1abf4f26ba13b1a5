#pragma once

#include <array>
#include <random>
#include <utility>
#include <vector>

#include "field/surfaces.h"
#include "kinequad/core/index.h"
#include "kinequad/gridmap/charted_mesh.h"
#include "kinequad/gridmap/map_system.h"
#include "kinequad/gridmap/map_variables.h"
#include "kinequad/gridmap/seamless_map.h"
#include "support/grid_maps.h"

/// What the steps of the grid map hand to one another, for tests of single steps.
namespace kinequad::test {

/// Solid of 13 cubes with two holes: a surface of genus 2.
inline TriangleMesh double_ring(int n) {
    std::vector<std::array<int, 3>> cubes;
    for (int x = 0; x < 5; ++x) {
        for (int y = 0; y < 3; ++y) {
            if (y != 1 || x % 2 == 0) cubes.push_back({x, y, 0});
        }
    }
    return map_polycube(cubes, n, 1).mesh;
}

/// Both meshes as one, the second moved aside.
inline TriangleMesh beside(const TriangleMesh& a, const TriangleMesh& b) {
    TriangleMesh both;
    both.V.resize(a.V.rows() + b.V.rows(), 3);
    both.V << a.V, b.V.rowwise() + Eigen::RowVector3d(10, 0, 0);
    both.F.resize(a.F.rows() + b.F.rows(), 3);
    both.F << a.F, (b.F.array() + static_cast<int>(a.V.rows())).matrix();
    return both;
}

/// A mesh cut into discs, with the variables of its maps.
struct PreparedMap {
    ChartedMesh mesh;
    std::vector<char> nodes;
    CutGraph cut;
    MapVariables variables;
    std::vector<TargetShape> shapes;
};

inline PreparedMap prepare(ChartedMesh mesh) {
    PreparedMap prepared;
    prepared.mesh = std::move(mesh);
    separate_singularities(prepared.mesh);
    prepared.nodes = find_nodes(prepared.mesh);
    prepared.cut = cut_to_discs(prepared.mesh, prepared.nodes);
    prepared.variables = build_map_variables(prepared.mesh, prepared.cut, prepared.nodes);
    prepared.shapes = target_shapes(prepared.mesh, 1);
    return prepared;
}

/// With about `cells` cells of the given field on the surface.
inline PreparedMap prepare(const Surface& surface, const CrossField& field, double cells) {
    const double area = triangle_areas(surface.topology, surface.metric).sum();
    return prepare(build_charts(surface.topology, surface.metric, field, std::sqrt(area / cells)));
}

inline PreparedMap prepare(const Surface& surface, double cells) {
    return prepare(surface, field_of(surface), cells);
}

/// Surfaces of several genera, with and without boundary, whose fields have room for maps.
inline std::vector<Surface> map_surfaces() {
    return {surface_of(cube(6), "cube"),
            surface_of(sphere(3), "sphere"),
            surface_of(torus(24, 12), "torus"),
            flat_torus(8, 6),
            surface_of(square(7), "square"),
            surface_of(cylinder(20, 9), "cylinder"),
            surface_of(double_ring(3), "genus 2"),
            surface_of(beside(cube(4), torus(16, 8)), "two components")};
}

inline Eigen::VectorXd random_vector(Eigen::Index size, std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    Eigen::VectorXd x(size);
    for (double& value : x) value = uniform(random);
    return x;
}

/// A half-edge's end in the chart it starts in, less its start.
inline Complex displacement(const std::vector<Complex>& corners, int h) {
    return corners[at(Topology::next(h))] - corners[at(h)];
}

}  // namespace kinequad::test
