#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "kinequad/deformation/compute_mean_metric.h"
#include "kinequad/io/open_sequence.h"
#include "kinequad/symmetry/compute_mirror_map.h"
#include "kinequad/symmetry/compute_symmetry_map.h"
#include "kinequad/symmetry/find_mirror_plane.h"
#include "kinequad/symmetry/verify_symmetry_map.h"
#include "support/data.h"
#include "symmetry/symmetric_shapes.h"

namespace kinequad {
namespace {

struct Mapped {
    TriangleMesh mesh;
    Landmarks landmarks;
    SymmetryMap map;
};

Mapped map_sequence(const std::string& name) {
    const auto frames =
        open_sequence((test::data_folder() / "sequences" / (name + ".obj")).string());
    Mapped result;
    result.mesh = {frames->read_rest_shape(), frames->triangles()};
    result.landmarks = read_landmarks(test::data_folder() / "landmarks" / (name + ".json"));
    const Topology topology = build_topology(result.mesh.F, frames->vertex_count());
    result.map = compute_symmetry_map(result.mesh, compute_mean_metric(*frames, topology, {}),
                                      result.landmarks, {}, {});
    return result;
}

struct Expected {
    const char* name;
    double involution_percent;
    int reversed_triangles;
    int loops;
};

class RealSymmetry : public testing::TestWithParam<Expected> {};

TEST_P(RealSymmetry, IsAnInvolutionWithOneLine) {
    KINEQUAD_REQUIRE_DATA();
    const Expected& expected = GetParam();
    const Mapped result = map_sequence(expected.name);
    const SymmetryReport report = verify_symmetry_map(result.mesh, result.map);
    EXPECT_TRUE(report.is_complete) << report.problem;
    EXPECT_LT(report.involution_mean_percent, expected.involution_percent);
    EXPECT_LE(result.map.quality.reversed_triangles, expected.reversed_triangles);
    EXPECT_EQ(report.stationary_loops, expected.loops);
    EXPECT_LT(report.stationary_percent, 0.1);
    // The landmarks themselves are met.
    double worst = 0;
    for (const auto& [a, b] : result.landmarks.pairs) {
        const Vector3 image = position_of(result.map.vertex_image[static_cast<std::size_t>(a)],
                                          result.mesh.V, result.mesh.F);
        worst = std::max(worst, (image - result.mesh.V.row(b).transpose()).norm());
    }
    EXPECT_LT(100 * worst / bounding_box_diagonal(result.mesh.V), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(
    Sequences, RealSymmetry,
    testing::Values(Expected{"samba", 0.08, 10, 1}, Expected{"bouncing", 0.09, 10, 1},
                    Expected{"cat-poses", 0.1, 15, 1}, Expected{"horse-gallop", 0.06, 40, 1},
                    Expected{"wolf", 0.08, 15, 1}, Expected{"pjump", 0.05, 15, 1}),
    [](const auto& info) {
        std::string name = info.param.name;
        name.erase(std::remove(name.begin(), name.end(), '-'), name.end());
        return name;
    });

TEST(RealParts, OfARoosterAreMirroredOneByOne) {
    KINEQUAD_REQUIRE_DATA();
    const auto frames = open_sequence((test::data_folder() / "sequences" / "chicken.obj").string());
    const TriangleMesh mesh{frames->read_rest_shape(), frames->triangles()};
    const MirrorPlane plane = find_mirror_plane(mesh, {});
    EXPECT_GT(plane.residual_percent, symmetric_pose_percent);
    const SymmetryMap map = compute_mirror_map(mesh, plane, test::metric_of(mesh), {});
    const SymmetryReport report = verify_symmetry_map(mesh, map);
    EXPECT_TRUE(report.is_complete) << report.problem;
    EXPECT_LT(report.involution_mean_percent, 0.1);
    EXPECT_LT(map.quality.reversed_triangles, 150);
    // All 41 parts fall on one part, and back.
    const Topology topology = build_topology(mesh.F, frames->vertex_count());
    const std::vector<int> part = triangle_components(topology);
    std::vector<int> partner(41, -1);
    for (std::size_t t = 0; t < part.size(); ++t) {
        int& of_part = partner[static_cast<std::size_t>(part[t])];
        const int there = part[static_cast<std::size_t>(map.centre_image[t].triangle)];
        if (of_part < 0) of_part = there;
        EXPECT_EQ(of_part, there);
    }
    int alone = 0;
    for (std::size_t p = 0; p < partner.size(); ++p) {
        EXPECT_EQ(partner[static_cast<std::size_t>(partner[p])], static_cast<int>(p));
        if (partner[p] == static_cast<int>(p)) ++alone;
    }
    // Body, head, tongue and the like, and some tail feathers; eyes, wings and feet are pairs.
    EXPECT_LE(alone, 15);
}

class MakeHuman : public testing::TestWithParam<const char*> {};

TEST_P(MakeHuman, HasItsTrueMirrorMap) {
    KINEQUAD_REQUIRE_DATA();
    const Mapped result = map_sequence(GetParam());
    std::ifstream file(test::data_folder() / "sequences" / "makehuman_mirror.txt");
    std::vector<int> mirror;
    for (int v = 0; file >> v;) mirror.push_back(v);
    ASSERT_EQ(static_cast<Eigen::Index>(mirror.size()), result.mesh.V.rows());
    Eigen::VectorXd error = test::map_errors(result.mesh, result.map.vertex_image, mirror);
    std::sort(error.begin(), error.end());
    EXPECT_LT(error.mean(), 0.02);
    EXPECT_LT(error[error.size() * 99 / 100], 0.3);
    ASSERT_EQ(result.map.stationary.size(), 1U);
    double off = 0;
    for (const SurfacePoint& point : result.map.stationary[0]) {
        off += std::abs(position_of(point, result.mesh.V, result.mesh.F)[0]);
    }
    off /= static_cast<double>(result.map.stationary[0].size());
    EXPECT_LT(100 * off / bounding_box_diagonal(result.mesh.V), 0.05);
    EXPECT_EQ(result.map.quality.reversed_triangles, 0);
}

INSTANTIATE_TEST_SUITE_P(Sequences, MakeHuman, testing::Values("makehuman_squat", "makehuman_walk"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace kinequad
