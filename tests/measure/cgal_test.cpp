// Our distances and angles against those of CGAL, where it is installed. CGAL is used by this test
// alone and is no part of the program.
#include <gtest/gtest.h>

#ifdef KINEQUAD_HAS_CGAL

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Kernel/global_functions.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>

#include <random>

#include "kinequad/measure/quad_shape.h"
#include "kinequad/measure/surface_distance.h"
#include "quad_grid.h"
#include "support/shapes.h"

namespace kinequad {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;
using SurfaceMesh = CGAL::Surface_mesh<Point>;
using Primitive = CGAL::AABB_face_graph_triangle_primitive<SurfaceMesh>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

SurfaceMesh cgal_mesh(const TriangleMesh& mesh) {
    SurfaceMesh result;
    std::vector<SurfaceMesh::Vertex_index> vertices;
    for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
        vertices.push_back(result.add_vertex(Point(mesh.V(v, 0), mesh.V(v, 1), mesh.V(v, 2))));
    }
    for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
        const auto at = [&](int k) { return vertices[static_cast<std::size_t>(mesh.F(t, k))]; };
        result.add_face(at(0), at(1), at(2));
    }
    return result;
}

/// A torus with dents, so that no distance is the same twice.
TriangleMesh dented(TriangleMesh mesh, std::uint64_t seed, double depth) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform(-depth, depth);
    for (Eigen::Index i = 0; i < mesh.V.size(); ++i) mesh.V.data()[i] += uniform(random);
    return mesh;
}

TEST(AgainstCgal, DistancesOfPointsAgree) {
    const TriangleMesh mesh = dented(test::torus(40, 20), 1, 0.02);
    const SurfaceMesh other = cgal_mesh(mesh);
    const Tree tree(faces(other).first, faces(other).second, other);
    const ClosestPoints surface(mesh.V, mesh.F);
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> uniform(-2, 2);
    for (int i = 0; i < 2000; ++i) {
        const double x = uniform(random);
        const double y = uniform(random);
        const double z = uniform(random);
        const double expected = tree.squared_distance(Point(x, y, z));
        EXPECT_NEAR(surface.find({x, y, z}).squared_distance, expected, 1e-12 * (1 + expected));
    }
}

TEST(AgainstCgal, HausdorffDistancesAgreeWithinBothBounds) {
    const TriangleMesh input = dented(test::torus(40, 20), 2, 0.03);
    const TriangleMesh quads = test::torus(23, 11);
    const SurfaceMesh input_mesh = cgal_mesh(input);
    const SurfaceMesh quads_mesh = cgal_mesh(quads);
    const SurfaceDistance ours = measure_distance(input, quads);
    const double percent = 100 / bounding_box_diagonal(input.V);
    const double error = 1e-4;
    const auto expect_agree = [&](const DirectedDistance& d, double theirs) {
        EXPECT_LE(d.hausdorff_percent, (theirs + error) * percent);
        EXPECT_GE(d.hausdorff_bound_percent, (theirs - error) * percent);
        EXPECT_NEAR(d.hausdorff_percent, theirs * percent,
                    0.006 * theirs * percent + error * percent);
    };
    namespace pmp = CGAL::Polygon_mesh_processing;
    expect_agree(ours.quads_to_input, pmp::bounded_error_Hausdorff_distance<CGAL::Sequential_tag>(
                                          quads_mesh, input_mesh, error));
    expect_agree(ours.input_to_quads, pmp::bounded_error_Hausdorff_distance<CGAL::Sequential_tag>(
                                          input_mesh, quads_mesh, error));
}

TEST(AgainstCgal, AnglesAndScaledJacobiansAgree) {
    test::QuadGrid grid = test::quad_grid(12);
    std::mt19937_64 random(9);
    std::uniform_real_distribution<double> uniform(-0.02, 0.02);
    for (Eigen::Index i = 0; i < grid.X.size(); ++i) grid.X.data()[i] += uniform(random);
    const auto point = [&](int v) { return Point(grid.X(v, 0), grid.X(v, 1), grid.X(v, 2)); };
    double deviation = 0;
    double smallest = 1;
    for (Eigen::Index q = 0; q < grid.Q.rows(); ++q) {
        const auto corner = [&](int k) { return point(grid.Q(q, (k + 4) % 4)); };
        const auto normal = CGAL::cross_product(corner(2) - corner(0), corner(3) - corner(1));
        for (int k = 0; k < 4; ++k) {
            deviation +=
                std::abs(CGAL::approximate_angle(corner(k - 1), corner(k), corner(k + 1)) - 90);
            // The sine of the corner, seen along the quad's normal.
            const auto next = corner(k + 1) - corner(k);
            const auto previous = corner(k - 1) - corner(k);
            smallest = std::min(smallest,
                                CGAL::scalar_product(CGAL::cross_product(next, previous), normal) /
                                    std::sqrt(next.squared_length() * previous.squared_length() *
                                              normal.squared_length()));
        }
    }
    const QuadShapeMetrics ours = measure_shape(grid.X, grid.Q);
    EXPECT_NEAR(ours.angle_deviation_mean, deviation / (4.0 * double(grid.Q.rows())), 1e-9);
    EXPECT_NEAR(ours.scaled_jacobian_min, smallest, 1e-12);
}

}  // namespace
}  // namespace kinequad

#else

TEST(AgainstCgal, DistancesAndAnglesAgree) {
    GTEST_SKIP() << "this build goes without CGAL; install libcgal-dev to compare with it";
}

#endif
