#include "kinequad/transfer/carried_sequence.h"

#include <gtest/gtest.h>

#include "kinequad/io/memory_sequence.h"
#include "kinequad/mesh/refined_mesh.h"
#include "support/shapes.h"

namespace kinequad {
namespace {

TEST(CarriedSequence, ShowsTheSameSurfaceAndItsReflection) {
    const TriangleMesh mesh = test::sphere(2);
    const MemorySequence source(mesh.F, {mesh.V, 2 * mesh.V}, 3 * mesh.V);
    const RefinedMesh same = as_refined_mesh(mesh.F, static_cast<int>(mesh.V.rows()));
    const CarriedSequence carried(source, same.F, vertex_points(same));
    EXPECT_EQ(carried.frame_count(), 2);
    EXPECT_EQ(carried.read_frame(1), source.read_frame(1));
    EXPECT_EQ(carried.read_rest_shape(), source.read_rest_shape());
    const CarriedSequence mirrored(source, same.F, vertex_points(same), true);
    EXPECT_EQ(mirrored.read_frame(0).col(0), -mesh.V.col(0));
    EXPECT_EQ(mirrored.read_frame(0).col(2), mesh.V.col(2));
}

TEST(RefinedMesh, PointsOfAPartAreThoseOfTheInput) {
    RefinedMesh part;
    part.F.resize(1, 3);
    part.F << 0, 1, 2;
    part.vertex_count = 3;
    part.parent = {7};
    part.barycentric.resize(3, 3);
    part.barycentric << 1, 0, 0, 0.5, 0.5, 0, 0, 0, 1;
    const SurfacePoint point = point_of_input(part, {0, Vector3(0.5, 0.25, 0.25)});
    EXPECT_EQ(point.triangle, 7);
    EXPECT_TRUE(point.barycentric.isApprox(Vector3(0.625, 0.125, 0.25), 1e-15));
}

}  // namespace
}  // namespace kinequad
