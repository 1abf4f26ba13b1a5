#include "kinequad/gridmap/map_variables.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>

#include "gridmap/map_checks.h"
#include "kinequad/core/error.h"

namespace kinequad {
namespace {

TEST(MapVariables, AnyValuesGiveASeamlessMap) {
    std::mt19937 random(1);
    for (const test::Surface& surface : test::map_surfaces()) {
        SCOPED_TRACE(surface.name);
        const test::PreparedMap map = test::prepare(surface, 300);
        for (int run = 0; run < 3; ++run) {
            const Eigen::VectorXd x = test::random_vector(map.variables.columns(), random);
            test::expect_seamless(map.mesh, &map.cut.is_cut, map.variables.corner_coordinates(x));
        }
    }
}

TEST(MapVariables, WholeUnknownsGiveWholeNodesLinesAndTranslations) {
    std::mt19937 random(2);
    std::uniform_int_distribution<int> whole(-9, 9);
    for (const test::Surface& surface : test::map_surfaces()) {
        SCOPED_TRACE(surface.name);
        const test::PreparedMap map = test::prepare(surface, 300);
        const MapVariables& variables = map.variables;
        Eigen::VectorXd y(variables.integer_count());
        for (double& value : y) value = whole(random);
        Eigen::VectorXd x = test::random_vector(variables.columns(), random);
        x.tail(variables.chain_columns) = variables.lattice * y;
        const std::vector<Complex> corners = variables.corner_coordinates(x);
        for (int h = 0; h < 3 * map.mesh.triangle_count(); ++h) {
            const int v = map.mesh.origin[at(h)];
            if (map.nodes[at(v)]) {
                EXPECT_LT(test::whole_distance(corners[at(h)].real()), 1e-9);
                EXPECT_LT(test::whole_distance(corners[at(h)].imag()), 1e-9);
            }
            const int other = map.mesh.twin[at(h)];
            if (other < 0) {
                const Complex along = test::displacement(map.mesh.target, h);
                const bool is_horizontal = std::abs(along.real()) > std::abs(along.imag());
                EXPECT_LT(test::whole_distance(is_horizontal ? corners[at(h)].imag()
                                                             : corners[at(h)].real()),
                          1e-9);
                continue;
            }
            const Complex shift =
                corners[at(Topology::next(other))] - turn(corners[at(h)], map.mesh.rotation[at(h)]);
            EXPECT_LT(test::whole_distance(shift.real()), 1e-8);
            EXPECT_LT(test::whole_distance(shift.imag()), 1e-8);
        }
        for (const LinearForm<double>& form : variables.whole) {
            double value = 0;
            for (const auto& [c, f] : form) value += f * x[variables.vertex_columns + c];
            EXPECT_LT(test::whole_distance(value), 1e-9);
        }
    }
}

TEST(MapVariables, IntegerPartsAreTheCoordinatesWithoutVertexColumns) {
    std::mt19937 random(3);
    for (const test::Surface& surface : test::map_surfaces()) {
        SCOPED_TRACE(surface.name);
        const MapVariables variables = test::prepare(surface, 300).variables;
        const Eigen::VectorXd y = test::random_vector(variables.integer_count(), random);
        Eigen::VectorXd x = Eigen::VectorXd::Zero(variables.columns());
        x.tail(variables.chain_columns) = variables.lattice * y;
        const std::vector<Complex> corners = variables.corner_coordinates(x);
        for (std::size_t c = 0; c < corners.size(); ++c) {
            for (const int k : {0, 1}) {
                double value = 0;
                for (const auto& [i, f] : variables.integer_part[2 * c + at(k)]) {
                    value += static_cast<double>(f) * y[i];
                }
                EXPECT_NEAR(value, k == 0 ? corners[c].real() : corners[c].imag(), 1e-9);
            }
        }
    }
}

TEST(MapVariables, LatticeIsABasis) {
    for (const test::Surface& surface : test::map_surfaces()) {
        SCOPED_TRACE(surface.name);
        const MapVariables variables = test::prepare(surface, 300).variables;
        ASSERT_EQ(variables.lattice.rows(), variables.lattice.cols());
        const Eigen::FullPivLU<Eigen::MatrixXd> lattice(variables.lattice);
        EXPECT_EQ(lattice.rank(), variables.integer_count());
        EXPECT_LT((variables.lattice.array() - variables.lattice.array().round()).abs().maxCoeff(),
                  1e-12);
    }
}

TEST(MapVariables, CountsTheFreedomOfTheTopology) {
    // Closed, with holonomy: 2 (2 genus + cones - 2) moves of the cones and periods of the handles.
    for (const test::Surface& surface :
         {test::surface_of(test::cube(6)), test::surface_of(test::sphere(3)),
          test::surface_of(test::double_ring(3))}) {
        const test::PreparedMap map = test::prepare(surface, 300);
        int cones = 0;
        for (const int index : map.mesh.index) cones += index != 0 ? 1 : 0;
        const int handles = 2 - count_surface(surface.topology).euler_characteristic;
        EXPECT_EQ(map.variables.integer_count(), 2 * (handles + cones - 2));
        EXPECT_EQ(map.variables.vertex_columns, 2 * (map.mesh.vertex_count - cones));
    }
    // Without holonomy: two translations, of two coordinates each.
    EXPECT_EQ(test::prepare(test::flat_torus(8, 6), 48).variables.integer_count(), 4);
    // A rectangle has two sides.
    EXPECT_EQ(test::prepare(test::surface_of(test::square(5)), 25).variables.integer_count(), 2);
    // A cylinder has a circumference, a height and a twist, the nodes of its two ends apart.
    EXPECT_EQ(test::prepare(test::surface_of(test::cylinder(20, 9)), 200).variables.integer_count(),
              3);
}

TEST(FindNodes, EveryBoundaryLoopAndComponentHasOne) {
    const auto nodes_of = [](const test::Surface& surface) {
        const test::PreparedMap map = test::prepare(surface, 100);
        return std::count_if(map.nodes.begin(), map.nodes.end(), [](char c) { return c != 0; });
    };
    EXPECT_EQ(nodes_of(test::surface_of(test::cylinder(20, 9))), 2);
    EXPECT_EQ(nodes_of(test::flat_torus(8, 6)), 1);
    EXPECT_EQ(nodes_of(test::surface_of(test::square(5))), 4);
    EXPECT_EQ(nodes_of(test::surface_of(test::cube(4))), 8);
}

TEST(MapVariables, RefusesAFieldAcrossTheBoundary) {
    const test::Surface surface = test::surface_of(test::square(5));
    CrossField field = test::field_of(surface);
    field.angle.array() += 0.25 * std::numbers::pi;
    // Slanted crosses leave it to chance which line a boundary edge belongs to.
    field.angle.array() += 0.3 * Eigen::ArrayXd::Random(field.angle.size());
    EXPECT_THROW(test::prepare(surface, field, 25), GridMapError);
}

}  // namespace
}  // namespace kinequad
