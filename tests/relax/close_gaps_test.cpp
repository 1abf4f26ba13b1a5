// Quads and input are brought together in all frames.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "kinequad/relax/sliding_quads.h"
#include "relax/grid.h"

namespace kinequad {
namespace {

using namespace test;

double largest(const std::vector<double>& values) {
    return *std::max_element(values.begin(), values.end());
}

TEST(CloseGaps, CoversASpikeThatOnlyAnotherFrameShows) {
    int tip = -1;
    const Grid grid = spiked(&tip);
    Positions bent = grid.mesh.V;
    bent(tip, 2) = 0;
    SlidingQuads sliding = grid.sliding({{bent, 1}, {grid.mesh.V, 1}});
    const std::vector<double> left = sliding.close_gaps({0.45}, {}).at_quads;
    grid.expect_kept(sliding.quads());
    EXPECT_GT(grid.least_jacobian(sliding.quads(), bent), 0.1);
    Grid after = grid;
    after.quads = sliding.quads();
    const double farthest = after.farthest();
    EXPECT_LT(farthest, 0.45 / 6);
    // What it says is left, in units of the limit, is the distance in that frame.
    const double unit = 0.45 * grid.sliding({{grid.mesh.V, 1}}).mean_edge_length();
    EXPECT_NEAR(unit * largest(left), farthest, 0.05 * farthest);
}

TEST(CloseGaps, LeavesQuadsAloneThatAreNear) {
    const Grid grid(landscape(14, hill), 7, 0.3);
    SlidingQuads sliding = grid.sliding({{grid.mesh.V, 1}, {sheared(grid.mesh.V, 0.5), 1}});
    sliding.close_gaps({0.45}, {});
    EXPECT_TRUE(sliding.regions_moved_since({grid.quads.vertex, {}}).empty());
}

/// The square without the triangles whose middle is closer than `radius` to `centre`.
TriangleMesh with_hole(int n, const Vector3& centre, double radius) {
    TriangleMesh mesh = landscape(n, flat);
    Eigen::Index left = 0;
    for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
        const Eigen::RowVector3d middle =
            (mesh.V.row(mesh.F(t, 0)) + mesh.V.row(mesh.F(t, 1)) + mesh.V.row(mesh.F(t, 2))) / 3;
        if ((middle.transpose() - centre).norm() >= radius) mesh.F.row(left++) = mesh.F.row(t);
    }
    mesh.F.conservativeResize(left, 3);
    return mesh;
}

/// Wherever a quad leaves the input, that is found, whether samples show some of it (0 to 3) or, in
/// the middle of a half, none (4 to 7).
TEST(CloseGaps, FindsTheFarthestPlaceInsideAQuadWhereEveryFrameCounts) {
    constexpr int samples = 50;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(0.36, 0.64);
    std::uniform_real_distribution<double> size(0.25, 0.33);
    for (int i = 0; i < 8; ++i) {
        Vector3 centre(place(random), place(random), 0);
        double radius = size(random);
        if (i >= 4) {
            centre[1] = 0.2;
            radius *= 0.4;
        }
        // A large quad over the hole, and small ones, which make the unit short.
        Grid grid(with_hole(24, centre, radius), 20, 0);
        const int first = static_cast<int>(grid.quads.vertex.size());
        for (const auto& [x, y] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}) {
            grid.quads.vertex.push_back(grid.above(x, y));
        }
        const Quads small = grid.quads.Q.bottomRows(20);
        grid.quads.Q.resize(21, 4);
        grid.quads.Q << first, first + 1, first + 2, first + 3, small;
        const ClosestPoints surface = grid.surface();
        double farthest = 0;
        for (int j = 0; j < samples * samples; ++j) {
            const Vector3 point(double(j % samples) / samples, double(j / samples) / samples, 0);
            farthest = std::max(farthest, std::sqrt(surface.find(point).squared_distance));
        }
        SlidingQuads sliding = grid.sliding({{grid.mesh.V, 1}});
        const double unit = sliding.mean_edge_length();
        const double found = unit * sliding.close_gaps({1, true}, {}).at_quads[0];
        EXPECT_NEAR(found, farthest, 0.08 * unit + 1.0 / samples) << i;
    }
}

/// A flat grid without the quads within `radius` of `middle`, and how far that is from the rest.
std::pair<Grid, double> with_disc_left_out(const Grid& grid, const Vector3& middle, double radius) {
    Grid holed = grid;
    Eigen::Index left = 0;
    for (Eigen::Index q = 0; q < grid.quads.Q.rows(); ++q) {
        const QuadCorners p = grid.corners(grid.quads, grid.mesh.V, q);
        if (((p[0] + p[2]) / 2 - middle).norm() < radius) continue;
        holed.quads.Q.row(left++) = grid.quads.Q.row(q);
    }
    holed.quads.Q.conservativeResize(left, 4);
    Positions places(static_cast<Eigen::Index>(holed.quads.vertex.size()), 3);
    for (Eigen::Index v = 0; v < places.rows(); ++v) {
        places.row(v) =
            position_of(holed.quads.vertex[static_cast<std::size_t>(v)], grid.mesh.V, grid.mesh.F);
    }
    const ClosestPoints quads(places, cut_quads(holed.quads.Q, places));
    return {holed, std::sqrt(quads.find(middle).squared_distance)};
}

/// The largest distance that closing gaps finds, where hardly anything can move.
double found_beside(const Grid& grid, GapOptions options) {
    SlidingQuads sliding = grid.sliding({{grid.mesh.V, 1}});
    const double unit = options.limit * sliding.mean_edge_length();
    return unit * largest(sliding.close_gaps(options, {}).at_quads);
}

/// Where the farthest alone are looked at, so is the place of the input that is farthest from the
/// quads, inside a triangle: whether its corners are far, too, or only points on its edges.
TEST(CloseGaps, FindsTheFarthestPlaceInsideATriangleOfTheInput) {
    const Grid grid(landscape(8, flat), 40, 0);
    for (const auto& [radius, limit] : {std::pair{0.2, 4.0}, {0.06, 1.0}}) {
        for (const Eigen::Index t : {53, 54, 72, 73}) {
            Vector3 middle = Vector3::Zero();
            for (const int v : grid.mesh.F.row(t)) middle += grid.mesh.V.row(v).transpose() / 3;
            const auto [holed, farthest] = with_disc_left_out(grid, middle, radius);
            const GapOptions options{
                .limit = limit, .every_frame_counts = true, .only_farthest = true};
            EXPECT_NEAR(found_beside(holed, options), farthest, 0.012)
                << t << " with a radius of " << radius;
        }
    }
}

/// Also on an edge of the input that is as long as forty of the quads.
TEST(CloseGaps, FindsTheFarthestPlaceOnALongEdgeOfTheInput) {
    const Grid grid(landscape(1, flat), 40, 0);
    for (const double share : {3.0 / 16, 5.0 / 16, 9.0 / 16, 0.44, 0.7}) {
        const auto [holed, farthest] = with_disc_left_out(grid, Vector3(share, 0, 0), 0.06);
        EXPECT_NEAR(found_beside(holed, {.limit = 1, .every_frame_counts = true}), farthest, 0.022)
            << share;
    }
}

/// What is near is told apart less well, but what is far is as far.
TEST(CloseGaps, TellsFarPlacesAsWellWhereEveryFrameCounts) {
    int tip = -1;
    const Grid grid = spiked(&tip);
    SlidingQuads exact = grid.sliding({{grid.mesh.V, 1}});
    SlidingQuads rough = grid.sliding({{grid.mesh.V, 1}});
    // With a limit that nothing exceeds both only look.
    const GapsLeft known = exact.close_gaps({2}, {});
    const GapsLeft roughly_known = rough.close_gaps({2, true}, {});
    EXPECT_TRUE(rough.regions_moved_since({grid.quads.vertex, {}}).empty());
    EXPECT_GT(known.mean_farthest, roughly_near_share / 2);
    EXPECT_EQ(known.mean_farthest, roughly_known.mean_farthest);
    for (std::size_t q = 0; q < known.at_quads.size(); ++q) {
        EXPECT_NEAR(roughly_known.at_quads[q], known.at_quads[q], roughly_near_share / 2) << q;
    }
}

TEST(MeanFarthest, IsTheHeightOfASpikeInEdgesAndMovesNothing) {
    int tip = -1;
    const Grid grid = spiked(&tip);
    Positions bent = grid.mesh.V;
    bent(tip, 2) = 0;
    // The spike is 0.12 high, quads are a sixth wide.
    SlidingQuads sliding = grid.sliding({{grid.mesh.V, 1}});
    EXPECT_NEAR(sliding.mean_farthest({}), 0.72, 1e-9);
    EXPECT_EQ(sliding.quads().vertex, grid.quads.vertex);
    EXPECT_NEAR(grid.sliding({{grid.mesh.V, 1}, {bent, 0}}).mean_farthest({}),
                (0.72 + near_share) / 2, 1e-9);
}

TEST(CloseGaps, CountsTheFarthestOfEveryFrame) {
    int tip = -1;
    const Grid grid = spiked(&tip);
    Positions bent = grid.mesh.V;
    bent(tip, 2) = 0;
    const auto farthest = [&](std::vector<SampledFrame> frames) {
        return grid.sliding(std::move(frames)).close_gaps({2}, {}).mean_farthest;
    };
    const double flat = farthest({{bent, 1}});
    const double spiked = farthest({{grid.mesh.V, 1}});
    EXPECT_NEAR(farthest({{bent, 1}, {grid.mesh.V, 0}}), (flat + spiked) / 2, 1e-12);
}

/// The largest distance between quads and a spike, in units of the limit, once gaps are closed.
double left_at_spike(const GapOptions& options) {
    int tip = -1;
    const Grid grid = spiked(&tip);
    return largest(grid.sliding({{grid.mesh.V, 1}}).close_gaps(options, {}).at_quads);
}

TEST(CloseGaps, BeyondTheLimitCountsForMoreWhenRough) {
    bool is_any_closer = false;
    for (const double weight : {1., 3., 10., 30., 100.}) {
        const double exact = left_at_spike({.limit = 0.45, .shape_weight = weight});
        const double rough =
            left_at_spike({.limit = 0.45, .every_frame_counts = true, .shape_weight = weight});
        if (exact > 1) {
            EXPECT_LE(rough, exact + 1e-9) << weight;
        }
        if (rough < 0.9 * exact) is_any_closer = true;
    }
    EXPECT_TRUE(is_any_closer);
}

TEST(CloseGaps, MakesNoEdgeLongerThanIsAllowed) {
    int tip = -1;
    const Grid grid = spiked(&tip);
    const auto longest_edge = [&](const QuadMesh& quads) {
        double longest = 0;
        for (Eigen::Index q = 0; q < quads.Q.rows(); ++q) {
            const QuadCorners p = grid.corners(quads, grid.mesh.V, q);
            for (std::size_t k = 0; k < 4; ++k) {
                longest = std::max(longest, (p[(k + 1) % 4] - p[k]).norm());
            }
        }
        return longest;
    };
    const double mean = grid.sliding({{grid.mesh.V, 1}}).mean_edge_length();
    const double before = longest_edge(grid.quads) / mean;
    std::vector<double> lefts;
    for (const double stretch : {1.0, 1.5, 3.0}) {
        SlidingQuads sliding = grid.sliding({{grid.mesh.V, 1}});
        lefts.push_back(
            largest(sliding.close_gaps({.limit = 0.3, .most_stretch = stretch}, {}).at_quads));
        EXPECT_LE(longest_edge(sliding.quads()) / mean, std::max(before, stretch) + 1e-9);
    }
    EXPECT_LT(lefts.back(), 0.9 * lefts.front());
}

/// Of four frames three show a cone beside the one vertex that may move, and one a pyramid with its
/// apex there. What is best in the three, which are looked at first, takes the vertex too far off
/// the apex; another place leaves nothing far in any.
TEST(CloseGaps, LooksAgainWhereAnotherFrameForbidsThePlaceWhenRough) {
    constexpr double limit = 0.1;
    const Grid grid(landscape(40,
                              [](double x, double y) {
                                  return 0.15 *
                                         std::max(0.0, 1 - std::hypot(x - 0.7, y - 0.5) / 0.3);
                              }),
                    2, 0);
    for (const double height : {0.4, 0.6, 0.8}) {
        const auto pyramid = [&](double x, double y) {
            return height * std::max(0.0, 1 - 2 * (std::abs(x - 0.5) + std::abs(y - 0.5)));
        };
        SlidingQuads sliding = grid.sliding(
            {{grid.mesh.V, 1}, {grid.mesh.V, 1}, {grid.mesh.V, 1}, {landscape(40, pyramid).V, 1}});
        const GapsLeft left = sliding.close_gaps(
            {.limit = limit, .every_frame_counts = true, .shape_weight = 1e-3}, {});
        EXPECT_NEAR(limit * left.mean_farthest, roughly_near_share, 1e-9) << height;
    }
}

/// A spike on the boundary, where vertices stay, is the farthest for good: a lower one inside is
/// left alone, unless it is the farthest in another frame.
TEST(CloseGaps, MendsTheFarthestPlaceOfEveryFrameAlone) {
    const auto spikes = [](double at_boundary) {
        return landscape(40, [=](double x, double y) {
            const auto cone = [&](double height, double u, double v) {
                return height * std::max(0.0, 1 - std::hypot(x - u, y - v) / 0.06);
            };
            return cone(at_boundary, 0.45, 0) + cone(0.1, 0.75, 0.75);
        });
    };
    const Grid grid(spikes(0.3), 10, 0);
    const Positions without = spikes(0).V;
    constexpr std::size_t inner_quad = 77;
    const auto left_inside = [&](std::vector<SampledFrame> frames, bool only_farthest) {
        SlidingQuads sliding = grid.sliding(std::move(frames));
        const GapOptions options{
            .limit = 0.3, .every_frame_counts = true, .only_farthest = only_farthest};
        return sliding.close_gaps(options, {}).at_quads[inner_quad];
    };
    const double mended = left_inside({{grid.mesh.V, 1}}, false);
    const double left_alone = left_inside({{grid.mesh.V, 1}}, true);
    EXPECT_LT(mended, 0.7 * left_alone);
    EXPECT_NEAR(left_alone, 0.1 / 0.3 * 10, 0.1);
    EXPECT_LT(left_inside({{grid.mesh.V, 1}, {without, 1}}, true), 0.7 * left_alone);
}

/// Cones of many heights between the vertices of the grid.
TEST(CloseGaps, DraggedPatchesComeCloserThanVerticesAlone) {
    int closer = 0;
    for (const double height : {0.12, 0.18, 0.24, 0.3, 0.36}) {
        const auto cone = [&](double x, double y) {
            return height * std::max(0.0, 1 - std::hypot(x - 0.58, y - 0.46) / 0.16);
        };
        const Grid grid(landscape(24, cone), 6, 0);
        SlidingQuads alone = grid.sliding({{grid.mesh.V, 1}});
        SlidingQuads dragged = grid.sliding({{grid.mesh.V, 1}});
        const double left_alone = largest(alone.close_gaps({0.3}, {}).at_quads);
        const double left = largest(dragged.close_gaps({0.3, false, true}, {}).at_quads);
        grid.expect_kept(dragged.quads());
        EXPECT_GT(grid.least_jacobian(dragged.quads(), grid.mesh.V), 0) << height;
        EXPECT_LE(left, left_alone + 1e-12) << height;
        if (left < 0.9 * left_alone) ++closer;
        if (height > 0.3) {
            EXPECT_LT(left, 0.7 * left_alone) << height;
        }
    }
    EXPECT_GE(closer, 3);
}

}  // namespace
}  // namespace kinequad
