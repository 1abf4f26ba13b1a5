#include "kinequad/symmetry/symmetric_half.h"

#include <gtest/gtest.h>

#include "kinequad/symmetry/compute_mirror_map.h"
#include "kinequad/symmetry/compute_symmetry_map.h"
#include "kinequad/symmetry/even_out_half.h"
#include "symmetry/symmetric_shapes.h"

namespace kinequad {
namespace {

/// A shape that mirrors in x = 0, one half of it, and what is needed to ask for images.
struct HalfShape {
    test::SymmetricShape shape;
    Topology topology;
    IntrinsicMetric metric;
    SymmetricHalf half;
};

HalfShape half_of(const SymmetryMap& map, test::SymmetricShape shape) {
    HalfShape it{std::move(shape), {}, {}, {}};
    it.topology = build_topology(it.shape.mesh.F, static_cast<int>(it.shape.mesh.V.rows()));
    it.metric = metric_of(it.topology, it.shape.mesh.V);
    it.half = take_symmetric_half(it.topology, it.metric, map, it.shape.mesh.V, it.shape.mesh.F);
    return it;
}

SymmetryMap exact_map(const TriangleMesh& mesh) {
    const Topology topology = build_topology(mesh.F, static_cast<int>(mesh.V.rows()));
    return compute_mirror_map(mesh, {Vector3::UnitX(), 0, 0}, metric_of(topology, mesh.V), {});
}

Vector3 reflected(Vector3 p) {
    p[0] = -p[0];
    return p;
}

IntrinsicMetric metric_of_half(const HalfShape& it) {
    const RefinedMesh& half = it.half.mesh;
    Positions X(half.vertex_count, 3);
    const std::vector<SurfacePoint> points = vertex_points(half);
    for (std::size_t v = 0; v < points.size(); ++v) {
        X.row(static_cast<Eigen::Index>(v)) =
            position_of(points[v], it.shape.mesh.V, it.shape.mesh.F).transpose();
    }
    return metric_of(build_topology(half.F, half.vertex_count), X);
}

/// Largest distance of the images of the half's vertices from their true places.
double largest_error(const HalfShape& it, const std::vector<SurfacePoint>& images) {
    const TriangleMesh& mesh = it.shape.mesh;
    const std::vector<SurfacePoint> points = vertex_points(it.half.mesh);
    double largest = 0;
    for (std::size_t v = 0; v < points.size(); ++v) {
        largest = std::max(largest, (position_of(images[v], mesh.V, mesh.F) -
                                     reflected(position_of(points[v], mesh.V, mesh.F)))
                                        .norm());
    }
    return largest;
}

TEST(SymmetricHalf, IsADiscBoundedByTheCurve) {
    const test::SymmetricShape shape = test::bumpy_ellipsoid(4);
    const HalfShape it = half_of(exact_map(shape.mesh), shape);
    const Topology half = build_topology(it.half.mesh.F, it.half.mesh.vertex_count);
    EXPECT_EQ(count_surface(half).euler_characteristic, 1);
    EXPECT_EQ(count_surface(half).boundary_loops, 1);
    EXPECT_LT(largest_error(it, it.half.mirrored), 1e-9);
    int on_curve = 0;
    for (int v = 0; v < half.vertex_count; ++v) {
        on_curve += it.half.is_on_curve[static_cast<std::size_t>(v)];
        EXPECT_EQ(half.is_boundary_vertex(v),
                  it.half.is_on_curve[static_cast<std::size_t>(v)] != 0);
    }
    EXPECT_GT(on_curve, 10);
}

TEST(SymmetricHalf, ImagesOfPointsAreTheirReflections) {
    const test::SymmetricShape shape = test::bumpy_ellipsoid(4);
    const HalfShape it = half_of(exact_map(shape.mesh), shape);
    const TriangleMesh& mesh = it.shape.mesh;
    std::vector<SurfacePoint> points;
    for (int t = 0; t < static_cast<int>(it.half.mesh.F.rows()); t += 3) {
        points.push_back({t, Vector3(0.5, 0.2, 0.3)});
    }
    const std::vector<SurfacePoint> images =
        mirror_points(it.half, it.topology, it.metric, mesh.F, {mesh.V, 2 * mesh.V}, points, {});
    for (std::size_t i = 0; i < points.size(); ++i) {
        const SurfacePoint here = point_of_input(it.half.mesh, points[i]);
        EXPECT_LT(
            (position_of(images[i], mesh.V, mesh.F) - reflected(position_of(here, mesh.V, mesh.F)))
                .norm(),
            1e-9);
    }
}

TEST(EvenOutHalf, LeavesAnExactMapAlone) {
    const test::SymmetricShape shape = test::bumpy_ellipsoid(4);
    const HalfShape it = half_of(exact_map(shape.mesh), shape);
    const auto images = even_out_half(it.half, metric_of_half(it), it.topology, it.metric, 5, {});
    EXPECT_LT(largest_error(it, images), 1e-6);
}

TEST(EvenOutHalf, BringsDisplacedImagesBackAtAnyScale) {
    for (const double scale : {1.0, 1e-8, 1e8}) {
        SCOPED_TRACE(scale);
        test::SymmetricShape shape = test::bumpy_ellipsoid(4);
        shape.mesh.V *= scale;
        HalfShape it = half_of(exact_map(shape.mesh), shape);
        // Every image inside goes to the middle of a triangle beside it.
        for (std::size_t v = 0; v < it.half.mirrored.size(); ++v) {
            if (it.half.is_on_curve[v]) continue;
            it.half.mirrored[v].barycentric = Vector3::Constant(1.0 / 3);
        }
        const double before = largest_error(it, it.half.mirrored);
        const auto images =
            even_out_half(it.half, metric_of_half(it), it.topology, it.metric, 20, {});
        EXPECT_LT(largest_error(it, images), 0.3 * before);
    }
}

}  // namespace
}  // namespace kinequad
