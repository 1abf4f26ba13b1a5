#include "kinequad/field/verify_cross_field.h"

#include <gtest/gtest.h>

#include <cmath>

#include "field/surfaces.h"
#include "kinequad/field/singularities.h"

namespace kinequad {
namespace {

using test::field_of;
using test::Surface;
using test::surface_of;

CrossFieldReport report_of(const Surface& surface, const CrossField& field,
                           const CrossFieldOptions& options = {}) {
    return verify_cross_field(surface.topology, surface.metric, field, options);
}

TEST(VerifyCrossField, FindsEachKindOfDamage) {
    const Surface square = surface_of(test::square(5));
    const CrossField good = field_of(square);
    ASSERT_TRUE(report_of(square, good).valid());

    CrossField damaged = good;
    damaged.index[14] = 1;
    EXPECT_EQ(report_of(square, damaged).wrong_indices, 1);
    EXPECT_EQ(report_of(square, damaged).index_sum, 5);
    EXPECT_FALSE(report_of(square, damaged).valid());

    damaged = good;
    int inner = 0;
    while (square.topology.is_boundary_edge(inner)) ++inner;
    damaged.period_jump[inner] += 1;
    EXPECT_EQ(report_of(square, damaged).wrong_indices, 2);
    EXPECT_EQ(report_of(square, damaged).large_residuals, 1);

    damaged = good;
    damaged.angle[0] += 0.1;  // on the boundary
    EXPECT_EQ(report_of(square, damaged).unaligned_triangles, 1);
    EXPECT_FALSE(report_of(square, damaged).valid());

    damaged = good;
    damaged.period_jump[square.topology.edge[0]] = 2;
    EXPECT_EQ(report_of(square, damaged).periods_on_boundary, 1);
    EXPECT_FALSE(report_of(square, damaged).valid());

    damaged = good;
    damaged.angle[7] = std::nan("");
    EXPECT_FALSE(report_of(square, damaged).finite);
    EXPECT_FALSE(report_of(square, damaged).valid());
}

TEST(VerifyCrossField, MissesNothingThatOnlyTheMetricShows) {
    // A field of another metric has holonomies that are no quarter turns.
    const Surface cube = surface_of(test::cube(3));
    Surface other = cube;
    other.metric.edge_length[5] *= 1.2;
    const CrossFieldReport report = report_of(other, field_of(cube));
    EXPECT_EQ(report.broken_holonomies, 0);  // they are whole on any metric
    EXPECT_GT(report.largest_residual, 0.01);
}

TEST(VerifyCrossField, CountsSingularitiesThatAnEdgeJoins) {
    const Surface cube = surface_of(test::cube(1));
    const CrossField field = field_of(cube);
    // Eight corners, 18 edges, all of which join two of them.
    EXPECT_EQ(report_of(cube, field).adjacent_singularities, 18);
    EXPECT_EQ(count_adjacent_singularities(surface_of(test::cube(2)).topology,
                                           field_of(surface_of(test::cube(2)))),
              0);
}

TEST(Singularities, AreListedByVertexWithTheirBoundary) {
    const Surface square = surface_of(test::square(2));
    const std::vector<Singularity> expected = {
        {0, 1, true}, {2, 1, true}, {6, 1, true}, {8, 1, true}};
    EXPECT_EQ(list_singularities(square.topology, field_of(square)), expected);
}

}  // namespace
}  // namespace kinequad
