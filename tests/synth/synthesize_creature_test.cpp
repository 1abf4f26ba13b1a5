#include "kinequad/synth/synthesize_creature.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <tuple>

#include "kinequad/core/error.h"
#include "kinequad/mesh/topology.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {
namespace {

using Corners = std::array<int, 3>;

Corners from_lowest(Corners corners) {
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    return corners;
}

/// Triangles as sorted cycles, each corner sent through `map`, reversed where asked for.
std::vector<Corners> cycles(const Triangles& F, const std::vector<int>& map, bool reversed) {
    std::vector<Corners> found;
    for (Eigen::Index t = 0; t < F.rows(); ++t) {
        Corners corners{};
        for (int k = 0; k < 3; ++k) {
            corners[static_cast<std::size_t>(k)] = map[static_cast<std::size_t>(F(t, k))];
        }
        if (reversed) std::swap(corners[1], corners[2]);
        found.push_back(from_lowest(corners));
    }
    std::sort(found.begin(), found.end());
    return found;
}

double smallest_angle(const Positions& V, const Triangles& F, Eigen::Index t) {
    double least = std::numbers::pi;
    for (int k = 0; k < 3; ++k) {
        const Vector3 at = V.row(F(t, k)).transpose();
        const Vector3 u = V.row(F(t, (k + 1) % 3)).transpose() - at;
        const Vector3 w = V.row(F(t, (k + 2) % 3)).transpose() - at;
        least = std::min(least, std::atan2(u.cross(w).norm(), u.dot(w)));
    }
    return least * 180 / std::numbers::pi;
}

double signed_volume(const Positions& V, const Triangles& F) {
    double volume = 0;
    for (Eigen::Index t = 0; t < F.rows(); ++t) {
        const Vector3 a = V.row(F(t, 0)).transpose();
        const Vector3 b = V.row(F(t, 1)).transpose();
        const Vector3 c = V.row(F(t, 2)).transpose();
        volume += a.dot(b.cross(c)) / 6;
    }
    return volume;
}

class Creatures : public testing::TestWithParam<std::tuple<std::string, int>> {
protected:
    std::unique_ptr<SyntheticCreature> make(int frames = 12) const {
        const auto& [name, triangles] = GetParam();
        return synthesize_creature(name, {triangles, frames}, Context{});
    }
};

TEST_P(Creatures, AreClosedSpheresOfTheWantedSizeFacingOutwards) {
    const auto creature = make();
    const int wanted = std::get<1>(GetParam());
    EXPECT_NEAR(static_cast<double>(creature->triangles().rows()), wanted, 0.1 * wanted);
    const SurfaceCounts counts =
        count_surface(build_topology(creature->triangles(), creature->vertex_count()));
    EXPECT_EQ(counts.euler_characteristic, 2);
    EXPECT_EQ(counts.components, 1);
    EXPECT_EQ(counts.boundary_loops, 0);
    EXPECT_EQ(counts.vertices, creature->vertex_count());
    EXPECT_GT(signed_volume(creature->read_rest_shape(), creature->triangles()), 0.02);
}

TEST_P(Creatures, MirrorIsAnInvolutionThatReversesTriangles) {
    const auto creature = make();
    const std::vector<int>& mirror = creature->mirror();
    ASSERT_EQ(mirror.size(), static_cast<std::size_t>(creature->vertex_count()));
    std::vector<int> identity;
    for (std::size_t v = 0; v < mirror.size(); ++v) {
        const int image = mirror[v];
        ASSERT_GE(image, 0);
        ASSERT_LT(image, creature->vertex_count());
        EXPECT_EQ(mirror[static_cast<std::size_t>(image)], static_cast<int>(v));
        identity.push_back(static_cast<int>(v));
    }
    EXPECT_EQ(cycles(creature->triangles(), mirror, true),
              cycles(creature->triangles(), identity, false));
}

TEST_P(Creatures, RestShapeMirrorsBitForBit) {
    const auto creature = make();
    const Positions V = creature->read_rest_shape();
    int fixed = 0;
    for (Eigen::Index v = 0; v < V.rows(); ++v) {
        const int image = creature->mirror()[static_cast<std::size_t>(v)];
        fixed += image == v ? 1 : 0;
        EXPECT_EQ(V(image, 0), -V(v, 0));
        EXPECT_EQ(V(image, 1), V(v, 1));
        EXPECT_EQ(V(image, 2), V(v, 2));
    }
    EXPECT_GT(fixed, 8);
}

TEST_P(Creatures, TrianglesAreWellShapedAtRestAndInMotion) {
    const auto creature = make();
    for (const int frame : {-1, 0, 5}) {
        const Positions V = frame < 0 ? creature->read_rest_shape() : creature->read_frame(frame);
        std::vector<double> angles;
        for (Eigen::Index t = 0; t < creature->triangles().rows(); ++t) {
            angles.push_back(smallest_angle(V, creature->triangles(), t));
        }
        std::sort(angles.begin(), angles.end());
        EXPECT_GT(angles[angles.size() / 2], frame < 0 ? 45 : 38);
        EXPECT_GT(angles[angles.size() / 100], frame < 0 ? 20 : 10);
        EXPECT_GT(angles[0], frame < 0 ? 8 : 1);
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, Creatures,
                         testing::Combine(testing::Values("biped", "quadruped"),
                                          testing::Values(1000, 20000, 200000)),
                         [](const auto& tested) {
                             return std::get<0>(tested.param) + "_" +
                                    std::to_string(std::get<1>(tested.param));
                         });

TEST(SynthesizeCreature, NoFrameIsSymmetric) {
    for (const std::string& name : list_creatures()) {
        const auto creature = synthesize_creature(name, {2000, 24}, Context{});
        const double diagonal = bounding_box_diagonal(creature->read_rest_shape());
        for (int frame = 0; frame < creature->frame_count(); ++frame) {
            const Positions V = creature->read_frame(frame);
            // A symmetric pose has every edge as long as its mirror image, wherever it stands.
            double difference = 0;
            const auto& pairs = creature->landmarks().pairs;
            const auto at = [&](int v) { return V.row(v); };
            for (const auto& [i, j] : pairs) {
                for (const auto& [k, l] : pairs) {
                    difference = std::max(
                        difference, std::abs((at(i) - at(l)).norm() - (at(j) - at(k)).norm()));
                }
            }
            EXPECT_GT(difference, 0.04 * diagonal) << name << " frame " << frame;
        }
    }
}

TEST(SynthesizeCreature, MotionIsSmoothAndCloses) {
    const auto creature = synthesize_creature("biped", {2000, 48}, Context{});
    const double diagonal = bounding_box_diagonal(creature->read_rest_shape());
    Positions before = creature->read_frame(47);
    for (int frame = 0; frame < 48; ++frame) {
        const Positions now = creature->read_frame(frame);
        EXPECT_LT((now - before).rowwise().norm().maxCoeff(), 0.08 * diagonal) << frame;
        EXPECT_NEAR(now.col(1).minCoeff(), 0, 0.03) << frame;
        before = now;
    }
}

TEST(SynthesizeCreature, HalfACycleLaterTheMirrorImageIsSeen) {
    for (const std::string& name : list_creatures()) {
        const auto creature = synthesize_creature(name, {2000, 8}, Context{});
        const Positions now = creature->read_frame(1);
        const Positions later = creature->read_frame(5);
        for (Eigen::Index v = 0; v < now.rows(); ++v) {
            const int image = creature->mirror()[static_cast<std::size_t>(v)];
            const Vector3 expected(-now(v, 0), now(v, 1), now(v, 2));
            EXPECT_LT((later.row(image).transpose() - expected).norm(), 1e-9) << name << ' ' << v;
        }
    }
}

TEST(SynthesizeCreature, LandmarksArePairsOfMirrorImagesAndFixedVertices) {
    for (const std::string& name : list_creatures()) {
        const auto creature = synthesize_creature(name, {1000, 4}, Context{});
        EXPECT_NO_THROW(require_landmarks_fit(creature->landmarks(), creature->vertex_count()));
        std::set<int> seen(creature->landmarks().stationary.begin(),
                           creature->landmarks().stationary.end());
        for (const auto& pair : creature->landmarks().pairs) seen.insert(pair.begin(), pair.end());
        EXPECT_EQ(seen.size(),
                  creature->landmarks().stationary.size() + 2 * creature->landmarks().pairs.size());
        EXPECT_GE(creature->landmarks().pairs.size(), 4U);
        EXPECT_GE(creature->landmarks().stationary.size(), 3U);
        for (const auto& [left, right] : creature->landmarks().pairs) {
            EXPECT_NE(left, right);
            EXPECT_EQ(creature->mirror()[static_cast<std::size_t>(left)], right);
        }
        for (const int v : creature->landmarks().stationary) {
            EXPECT_EQ(creature->mirror()[static_cast<std::size_t>(v)], v);
        }
    }
}

TEST(SynthesizeCreature, SameBytesAtAnyNumberOfThreads) {
    Context context;
    context.threads = 1;
    const auto one = synthesize_creature("quadruped", {30000, 6}, context);
    for (const int threads : {2, 8}) {
        context.threads = threads;
        const auto other = synthesize_creature("quadruped", {30000, 6}, context);
        EXPECT_EQ(other->triangles(), one->triangles()) << threads;
        EXPECT_EQ(other->read_rest_shape(), one->read_rest_shape()) << threads;
        EXPECT_EQ(other->read_frame(4), one->read_frame(4)) << threads;
        EXPECT_EQ(other->mirror(), one->mirror()) << threads;
    }
}

TEST(SynthesizeCreature, RefusesWhatItCannotMake) {
    EXPECT_THROW(synthesize_creature("unicorn", {}, Context{}), InputError);
    EXPECT_THROW(synthesize_creature("biped", {10, 4}, Context{}), InputError);
    EXPECT_THROW(synthesize_creature("biped", {2000, 0}, Context{}), InputError);
    const auto creature = synthesize_creature("biped", {1000, 2}, Context{});
    EXPECT_THROW(creature->read_frame(2), InputError);
}

}  // namespace
}  // namespace kinequad
