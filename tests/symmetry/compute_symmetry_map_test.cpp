#include "kinequad/symmetry/compute_symmetry_map.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numeric>
#include <random>

#include "kinequad/core/error.h"
#include "kinequad/deformation/compute_mean_metric.h"
#include "kinequad/symmetry/format_symmetry_json.h"
#include "kinequad/symmetry/verify_symmetry_map.h"
#include "kinequad/synth/synthesize_creature.h"
#include "symmetry/symmetric_shapes.h"

namespace kinequad {
namespace {

using test::bumpy_ellipsoid;
using test::map_errors;
using test::SymmetricShape;

SymmetryMap map_of(const SymmetricShape& shape, const Context& context = {}) {
    return compute_symmetry_map(shape.mesh, test::metric_of(shape.mesh), shape.landmarks, {},
                                context);
}

TEST(SymmetryMap, OfABumpyEllipsoidIsTheMirror) {
    const SymmetricShape shape = bumpy_ellipsoid(4);
    const SymmetryMap map = map_of(shape);
    EXPECT_EQ(map.method, "conformal");
    EXPECT_LT(map_errors(shape.mesh, map.vertex_image, shape.mirror).maxCoeff(), 1e-6);
    EXPECT_LT(test::transport_error(shape.mesh, map.centre_image, map.transport, shape.mirror),
              1e-6);
    EXPECT_EQ(map.quality.reversed_triangles, 0);
    EXPECT_EQ(map.quality.unplaced_points, 0);
    EXPECT_LT(map.quality.fit_rms, 1e-8);
    EXPECT_LT(map.quality.landmark_difference_percent, 1e-9);
}

TEST(SymmetryMap, IsAnInvolution) {
    const SymmetricShape shape = bumpy_ellipsoid(4);
    const SymmetryReport report = verify_symmetry_map(shape.mesh, map_of(shape));
    EXPECT_TRUE(report.is_complete) << report.problem;
    EXPECT_LT(report.involution_max_percent, 1e-6);
    EXPECT_LT(report.stationary_percent, 1e-4);
    EXPECT_EQ(report.stationary_loops, 1);
    EXPECT_EQ(report.stationary_paths, 0);
}

TEST(SymmetryMap, HasItsStationaryCurveInTheMirrorPlane) {
    const SymmetricShape shape = bumpy_ellipsoid(4);
    const SymmetryMap map = map_of(shape);
    ASSERT_EQ(map.stationary.size(), 1U);
    EXPECT_EQ(map.stationary_direction.size() + 1, map.stationary[0].size());
    double length = 0;
    for (std::size_t i = 0; i < map.stationary[0].size(); ++i) {
        const Vector3 p = position_of(map.stationary[0][i], shape.mesh.V, shape.mesh.F);
        EXPECT_LT(std::abs(p[0]), 1e-5);
        if (i == 0) continue;
        length += (p - position_of(map.stationary[0][i - 1], shape.mesh.V, shape.mesh.F)).norm();
    }
    EXPECT_GT(length, 6);  // all the way round
    EXPECT_LT(length, 9);
    // The curve runs with the positive side on its left, and vertices lie on the side they are on.
    const double side = map.height[shape.landmarks.pairs[0][0]];
    for (Eigen::Index v = 0; v < shape.mesh.V.rows(); ++v) {
        if (std::abs(shape.mesh.V(v, 0)) < 1e-9) continue;
        EXPECT_EQ(map.height[v] > 0, (shape.mesh.V(v, 0) > 0) == (side > 0)) << v;
    }
}

TEST(SymmetryMap, CarriesDirectionsThereAndBack) {
    const SymmetricShape shape = bumpy_ellipsoid(4);
    const SymmetryMap map = map_of(shape);
    int compared = 0;
    for (int t = 0; t < shape.mesh.F.rows(); ++t) {
        const int s = map.centre_image[static_cast<std::size_t>(t)].triangle;
        if (map.centre_image[static_cast<std::size_t>(s)].triangle != t) continue;
        ++compared;
        const double x = 0.3;
        const double twice = map.transport[s] - (map.transport[t] - x);
        EXPECT_NEAR(std::remainder(twice - x, 2 * std::numbers::pi), 0, 1e-6);
    }
    EXPECT_GT(compared, shape.mesh.F.rows() / 2);
}

TEST(SymmetryMap, IsAlmostTheMirrorFromAnAnimationThatNeverShowsIt) {
    const auto creature = synthesize_creature("biped", {4000, 12}, {});
    const TriangleMesh mesh{creature->read_rest_shape(), creature->triangles()};
    const Topology topology = build_topology(mesh.F, creature->vertex_count());
    const IntrinsicMetric metric = compute_mean_metric(*creature, topology, {});
    const SymmetryMap map = compute_symmetry_map(mesh, metric, creature->landmarks(), {}, {});
    const Eigen::VectorXd error = map_errors(mesh, map.vertex_image, creature->mirror());
    EXPECT_LT(error.mean(), 0.3);
    EXPECT_LT(verify_symmetry_map(mesh, map).involution_mean_percent, 0.1);
}

TEST(SymmetryMap, DoesNotDependOnNumberingOrScale) {
    const auto creature = synthesize_creature("biped", {3000, 4}, {});
    const TriangleMesh mesh{creature->read_frame(1), creature->triangles()};
    const SymmetryMap map =
        compute_symmetry_map(mesh, test::metric_of(mesh), creature->landmarks(), {}, {});
    std::vector<int> number(static_cast<std::size_t>(mesh.V.rows()));
    std::iota(number.begin(), number.end(), 0);
    std::shuffle(number.begin(), number.end(), std::mt19937(7));
    TriangleMesh other = test::renumbered(mesh, number);
    other.V *= 1e-5;
    Landmarks landmarks;
    for (const auto& [a, b] : creature->landmarks().pairs) {
        landmarks.pairs.push_back(
            {number[static_cast<std::size_t>(b)], number[static_cast<std::size_t>(a)]});
    }
    for (const int v : creature->landmarks().stationary) {
        landmarks.stationary.push_back(number[static_cast<std::size_t>(v)]);
    }
    const SymmetryMap again =
        compute_symmetry_map(other, test::metric_of(other), landmarks, {}, {});
    double sum = 0;
    for (std::size_t v = 0; v < number.size(); ++v) {
        const Vector3 there = position_of(map.vertex_image[v], mesh.V, mesh.F);
        const Vector3 here =
            1e5 *
            position_of(again.vertex_image[static_cast<std::size_t>(number[v])], other.V, other.F);
        sum += (there - here).norm() / bounding_box_diagonal(mesh.V);
    }
    EXPECT_LT(100 * sum / static_cast<double>(number.size()), 0.01);
}

TEST(SymmetryMap, DoesNotDependOnThePoseOrTheThreads) {
    const auto creature = synthesize_creature("quadruped", {3000, 4}, {});
    const TriangleMesh mesh{creature->read_frame(2), creature->triangles()};
    const IntrinsicMetric metric = test::metric_of(mesh);
    std::vector<std::string> texts;
    for (const int threads : {1, 2, 8}) {
        Context context;
        context.threads = threads;
        const SymmetryMap map =
            compute_symmetry_map(mesh, metric, creature->landmarks(), {}, context);
        texts.push_back(format_symmetry_json(map));
        std::string transport(static_cast<std::size_t>(map.transport.size()) * 8, ' ');
        std::memcpy(transport.data(), map.transport.data(), transport.size());
        texts.back() += transport;
    }
    EXPECT_EQ(texts[0], texts[1]);
    EXPECT_EQ(texts[0], texts[2]);
}

/// `mesh` without the triangles around a vertex.
TriangleMesh without_star(const TriangleMesh& mesh, const std::vector<int>& vertices) {
    TriangleMesh result = mesh;
    int row = 0;
    for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
        bool is_kept = true;
        for (int k = 0; k < 3; ++k) {
            for (const int v : vertices) is_kept = is_kept && mesh.F(t, k) != v;
        }
        if (is_kept) result.F.row(row++) = mesh.F.row(t);
    }
    result.F.conservativeResize(row, 3);
    return result;
}

TEST(SymmetryMap, MatchesHolesToHolesAndEndsItsCurveAtThem) {
    SymmetricShape shape = bumpy_ellipsoid(4);
    const int front = test::vertex_towards(shape.mesh.V, {0, 0.3, 1});
    const int left = test::vertex_towards(shape.mesh.V, {1, -1, -1});
    const std::vector<int> holes = {front, left, shape.mirror[static_cast<std::size_t>(left)]};
    shape.mesh = without_star(shape.mesh, holes);
    const SymmetryMap map = map_of(shape);
    EXPECT_LT(map_errors(shape.mesh, map.vertex_image, shape.mirror).maxCoeff(), 1e-4);
    for (const int v : holes) {
        EXPECT_EQ(map.vertex_image[static_cast<std::size_t>(v)].triangle, -1);
    }
    const SymmetryReport report = verify_symmetry_map(shape.mesh, map);
    EXPECT_EQ(report.stationary_loops, 0);
    EXPECT_EQ(report.stationary_paths, 1);
}

TEST(SymmetryMap, WeldsPartsOfOneSurface) {
    SymmetricShape shape = bumpy_ellipsoid(3);
    // The upper half gets vertices of its own along the seam.
    const Positions whole = shape.mesh.V;
    const TriangleMesh round = test::sphere(3);
    std::vector<int> copy(static_cast<std::size_t>(whole.rows()), -1);
    std::vector<int> seam;
    for (Eigen::Index t = 0; t < shape.mesh.F.rows(); ++t) {
        const bool is_upper = round.V(shape.mesh.F(t, 0), 1) + round.V(shape.mesh.F(t, 1), 1) +
                                  round.V(shape.mesh.F(t, 2), 1) >
                              0;
        for (int k = 0; is_upper && k < 3; ++k) {
            const int v = shape.mesh.F(t, k);
            if (std::abs(round.V(v, 1)) > 1e-9) continue;
            int& there = copy[static_cast<std::size_t>(v)];
            if (there < 0) {
                there = static_cast<int>(whole.rows()) + static_cast<int>(seam.size());
                seam.push_back(v);
            }
            shape.mesh.F(t, k) = there;
        }
    }
    const auto count = static_cast<Eigen::Index>(seam.size());
    ASSERT_GT(count, 0);
    shape.mesh.V.conservativeResize(whole.rows() + count, 3);
    for (Eigen::Index i = 0; i < count; ++i) {
        const int v = seam[static_cast<std::size_t>(i)];
        shape.mesh.V.row(whole.rows() + i) = whole.row(v);
        shape.mirror.push_back(shape.mirror[static_cast<std::size_t>(v)]);
    }
    const SymmetryMap map = map_of(shape);
    EXPECT_LT(map_errors(shape.mesh, map.vertex_image, shape.mirror).maxCoeff(), 1e-5);
}

TEST(SymmetryJson, HoldsImagesAndCurve) {
    const SymmetricShape shape = bumpy_ellipsoid(2);
    const SymmetryMap map = map_of(shape);
    const auto file = nlohmann::json::parse(format_symmetry_json(map));
    ASSERT_EQ(file["image"].size(), static_cast<std::size_t>(shape.mesh.V.rows()));
    for (std::size_t v = 0; v < map.vertex_image.size(); ++v) {
        EXPECT_EQ(file["image"][v][0], map.vertex_image[v].triangle);
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(file["image"][v][k + 1],
                      map.vertex_image[v].barycentric[static_cast<Eigen::Index>(k)]);
        }
    }
    ASSERT_EQ(file["stationary"].size(), 1U);
    EXPECT_EQ(file["stationary"][0].front(), file["stationary"][0].back());
    EXPECT_EQ(file["method"], "conformal");
    EXPECT_TRUE(file["quality"].contains("involution_mean_percent"));
}

TEST(VerifySymmetryMap, SaysWhatIsMissing) {
    const SymmetricShape shape = bumpy_ellipsoid(2);
    const SymmetryMap map = map_of(shape);
    SymmetryMap broken = map;
    broken.vertex_image[5].triangle = -1;
    EXPECT_EQ(verify_symmetry_map(shape.mesh, broken).problem, "vertex 5 has no image");
    broken = map;
    broken.transport[3] = std::nan("");
    EXPECT_FALSE(verify_symmetry_map(shape.mesh, broken).is_complete);
    broken = map;
    std::swap(broken.vertex_image[0], broken.vertex_image[40]);
    EXPECT_GT(verify_symmetry_map(shape.mesh, broken).involution_max_percent, 1);
}

}  // namespace
}  // namespace kinequad
