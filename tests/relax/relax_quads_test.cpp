#include "kinequad/relax/relax_quads.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "kinequad/io/memory_sequence.h"
#include "kinequad/relax/sliding_quads.h"
#include "relax/grid.h"

namespace kinequad {
namespace {

using namespace test;
using Aim = SlidingQuads::Aim;

TEST(RelaxPass, LeavesAGridOfSquaresAlone) {
    const Grid grid(landscape(12, flat), 6, 0);
    SlidingQuads sliding = grid.sliding({{grid.mesh.V, 1}});
    EXPECT_EQ(sliding.relax_pass(Aim::squares, 1, {}), 0);
    EXPECT_EQ(sliding.relax_pass(Aim::right_angles, 1, {}), 0);
    EXPECT_NEAR(sliding.mean_edge_length(), 1.0 / 6, 1e-12);
}

TEST(RelaxPass, NeverRaisesTheCostOverAllFrames) {
    for (const unsigned seed : {1U, 2U, 3U}) {
        const Grid grid(landscape(14, hill), 7, 0.45, seed);
        const Positions other = sheared(grid.mesh.V, 0.7);
        SlidingQuads sliding = grid.sliding({{grid.mesh.V, 1}, {other, 2.5}});
        const auto cost = [&](const QuadMesh& of) {
            return grid.relaxing_cost(of, grid.mesh.V) + 2.5 * grid.relaxing_cost(of, other);
        };
        double before = cost(grid.quads);
        for (int pass = 0; pass < 8; ++pass) {
            const Aim aim = pass % 3 == 0 ? Aim::squares : Aim::right_angles;
            const int moves = sliding.relax_pass(aim, 1, {});
            const double after = cost(sliding.quads());
            EXPECT_LE(after, before + 1e-12);
            if (moves > 0) {
                EXPECT_LT(after, before);
            }
            before = after;
            grid.expect_kept(sliding.quads());
        }
    }
}

TEST(RelaxPass, FindsTheSquaresOfAFlatGrid) {
    const Grid grid(landscape(14, flat), 7, 0.3);
    SlidingQuads sliding = grid.sliding({{grid.mesh.V, 1}});
    const double before = grid.cost(grid.quads, grid.mesh.V);
    for (int pass = 0; pass < 60; ++pass) sliding.relax_pass(Aim::squares, 1, {});
    EXPECT_LT(grid.cost(sliding.quads(), grid.mesh.V), 0.05 * before);
}

TEST(RelaxPass, GoesOnToRightAnglesWhereSquaresAreOutOfReach) {
    // Frames that shear one way and the other, and a third that pulls squares into rectangles: what
    // squares ask for is not where angles are best.
    const Grid grid(landscape(14, hill), 7, 0.3);
    const Positions other = sheared(grid.mesh.V, 0.6);
    Positions longer = grid.mesh.V;
    longer.col(1) *= 2.5;
    SlidingQuads sliding = grid.sliding({{grid.mesh.V, 1}, {other, 1}, {longer, 1}});
    const auto cost = [&] {
        return grid.cost(sliding.quads(), grid.mesh.V) + grid.cost(sliding.quads(), other) +
               grid.cost(sliding.quads(), longer);
    };
    for (int pass = 0; pass < 100; ++pass) sliding.relax_pass(Aim::squares, 1, {});
    ASSERT_EQ(sliding.relax_pass(Aim::squares, 1, {}), 0);
    const double of_squares = cost();
    EXPECT_GT(sliding.relax_pass(Aim::right_angles, 1, {}), 0);
    EXPECT_LT(cost(), of_squares);
}

TEST(LetSlide, MovesAVertexOfALineInWhicheverTriangleThatIsNamed) {
    Grid grid(landscape(12, flat), 6, 0);
    // The third vertex of the lower side is one edge of the input off the place it should have.
    constexpr std::size_t moved = 3;
    int count = 0;
    for (int corner = 0; corner < 3 * grid.topology.triangle_count; ++corner) {
        grid.quads.vertex[moved] = {corner / 3, Vector3::Unit(corner % 3)};
        const auto place = [&](const QuadMesh& quads) {
            return position_of(quads.vertex[moved], grid.mesh.V, grid.mesh.F);
        };
        if ((place(grid.quads) - Vector3(5.0 / 12, 0, 0)).norm() > 1e-9) continue;
        ++count;
        SlidingQuads sliding = grid.sliding({{grid.mesh.V, 1}});
        sliding.let_slide(boundary_edges(grid.topology));
        for (int pass = 0; pass < 40; ++pass) sliding.relax_pass(Aim::squares, 1, {});
        EXPECT_NEAR(place(sliding.quads())[0], 0.5, 0.01) << "named by triangle " << corner / 3;
        EXPECT_EQ(place(sliding.quads())[1], 0);
    }
    EXPECT_EQ(count, 3);
}

TEST(Hold, KeepsTheCornersOfAQuadUntilRelease) {
    const Grid grid(landscape(14, flat), 7, 0.3);
    SlidingQuads sliding = grid.sliding({{grid.mesh.V, 1}});
    const int quad = 24;
    sliding.hold(quad);
    const auto corner = [&] { return grid.corners(sliding.quads(), grid.mesh.V, quad); };
    const QuadCorners before = corner();
    sliding.relax_pass(Aim::squares, 1, {});
    EXPECT_EQ(corner(), before);
    sliding.release();
    sliding.relax_pass(Aim::squares, 1, {});
    EXPECT_NE(corner(), before);
}

TEST(Distances, SeeTheSpikeAtItsQuad) {
    int tip = -1;
    const Grid grid = spiked(&tip);
    const std::vector<double> distances = grid.sliding({{grid.mesh.V, 1}}).distances({});
    // Quads of a sixth: the spike at (0.55, 0.45), 0.12 high, stands on the one in row 2, column 3.
    const auto farthest = std::max_element(distances.begin(), distances.end());
    EXPECT_EQ(farthest - distances.begin(), 2 * 6 + 3);
    EXPECT_NEAR(*farthest, 0.12, 1e-12);
}

TEST(Distances, SeeTheSpikeThatTouchesAnotherPlaceInTheReference) {
    int tip = -1;
    const Grid grid = spiked(&tip);
    Positions bent = grid.mesh.V;
    bent.row(tip) << 0.95, 0.05, 0;
    const std::vector<double> alone = grid.sliding({{bent, 1}}).distances({});
    EXPECT_LT(*std::max_element(alone.begin(), alone.end()), 1e-12);
    const std::vector<double> distances = grid.sliding({{bent, 1}, {grid.mesh.V, 1}}).distances({});
    const auto farthest = std::max_element(distances.begin(), distances.end());
    EXPECT_EQ(farthest - distances.begin(), 2 * 6 + 3);
    EXPECT_NEAR(*farthest, 0.12, 1e-12);
}

TEST(RelaxPass, WeighsTheFrames) {
    // What is square in one frame is not in the sheared one: the heavier of them gets its way.
    const Grid grid(landscape(14, flat), 7, 0.2);
    const Positions other = sheared(grid.mesh.V, 0.5);
    const auto costs = [&](double weight) {
        SlidingQuads sliding = grid.sliding({{grid.mesh.V, 1}, {other, weight}});
        for (int pass = 0; pass < 20; ++pass) sliding.relax_pass(Aim::squares, 1, {});
        return std::pair(grid.cost(sliding.quads(), grid.mesh.V),
                         grid.cost(sliding.quads(), other));
    };
    const auto [light_first, light_other] = costs(0.01);
    const auto [heavy_first, heavy_other] = costs(100);
    EXPECT_LT(light_first, heavy_first);
    EXPECT_GT(light_other, heavy_other);
}

TEST(UnfoldPass, OpensFoldedQuads) {
    Grid grid(landscape(16, hill), 8, 0.1);
    // One vertex is pulled over its neighbour, as happens where a map is stretched in space.
    grid.quads.vertex[static_cast<std::size_t>(4 * 9 + 4)] = grid.above(0.66, 0.55);
    ASSERT_LE(grid.least_jacobian(grid.quads, grid.mesh.V), 0);
    SlidingQuads sliding = grid.sliding({{grid.mesh.V, 1}});
    int folded = 1;
    for (int pass = 0; pass < 5 && folded > 0; ++pass) folded = sliding.unfold_pass(0.15, 0, {});
    EXPECT_EQ(folded, 0);
    EXPECT_GT(grid.least_jacobian(sliding.quads(), grid.mesh.V), 0);
    grid.expect_kept(sliding.quads());
}

TEST(UnfoldPass, LeavesGoodQuadsAlone) {
    const Grid grid(landscape(12, hill), 6, 0.1);
    SlidingQuads sliding = grid.sliding({{grid.mesh.V, 1}});
    ASSERT_GT(grid.least_jacobian(grid.quads, grid.mesh.V), 0.15);
    EXPECT_EQ(sliding.unfold_pass(0.15, 0, {}), 0);
    EXPECT_EQ(sliding.quads().vertex, grid.quads.vertex);
}

TEST(HugSurface, BringsAQuadThatBridgesAPitCloser) {
    const auto pit = [](double x, double y) {
        return std::min(0.0, 0.8 * std::hypot(x - 0.53, y - 0.53) - 0.08);
    };
    const Grid grid(landscape(28, pit), 7, 0);
    const auto at_the_pit = [&](const QuadMesh& quads) {
        Grid of = grid;
        of.quads = quads;
        return of.sliding({{grid.mesh.V, 1}}).distances({})[3 * 7 + 3];
    };
    const double before = at_the_pit(grid.quads);
    ASSERT_EQ(before, grid.farthest());
    SlidingQuads sliding = grid.sliding({{grid.mesh.V, 1}});
    sliding.hug_surface(1.1 * before, 0, {});
    EXPECT_EQ(sliding.quads().vertex, grid.quads.vertex);
    sliding.hug_surface(0.3 * before, 0, {});
    grid.expect_kept(sliding.quads());
    EXPECT_LT(at_the_pit(sliding.quads()), 0.5 * before);
    EXPECT_GT(grid.least_jacobian(sliding.quads(), grid.mesh.V), 0);
}

TEST(CoverExtremities, PutsAVertexOntoASpikeUntilRelease) {
    int tip = -1;
    const Grid grid = spiked(&tip);
    SlidingQuads sliding = grid.sliding({{grid.mesh.V, 1}});
    EXPECT_EQ(sliding.cover_extremities(0.2, {}), 0) << "the spike is not as high as that";
    EXPECT_EQ(sliding.cover_extremities(0.1, {}), 1);
    const auto nearest = [&](const QuadMesh& quads) {
        double least = 1;
        for (const SurfacePoint& point : quads.vertex) {
            least = std::min(least, (position_of(point, grid.mesh.V, grid.mesh.F) -
                                     grid.mesh.V.row(tip).transpose())
                                        .norm());
        }
        return least;
    };
    EXPECT_LT(nearest(sliding.quads()), 1e-12);
    EXPECT_EQ(sliding.cover_extremities(0.1, {}), 0);
    for (int pass = 0; pass < 5; ++pass) sliding.relax_pass(Aim::squares, 1, {});
    EXPECT_LT(nearest(sliding.quads()), 1e-12);
    EXPECT_GT(grid.least_jacobian(sliding.quads(), grid.mesh.V), 0);
    grid.expect_kept(sliding.quads());
    sliding.release();
    sliding.relax_pass(Aim::squares, 1, {});
    EXPECT_GT(nearest(sliding.quads()), 0.01);
}

TEST(Regions, AreWhatMovedAndGoBackAlone) {
    TriangleMesh mesh = landscape(40, flat);
    for (const double x : {0.29, 0.79}) {
        Eigen::Index tip = 0;
        (mesh.V.rowwise() - Eigen::RowVector3d(x, 0.55, 0)).rowwise().squaredNorm().minCoeff(&tip);
        mesh.V(tip, 2) = 0.1;
    }
    const Grid grid(std::move(mesh), 12, 0);
    SlidingQuads sliding = grid.sliding({{grid.mesh.V, 1}});
    const SlidingQuads::State before = sliding.state();
    EXPECT_TRUE(sliding.regions_moved_since(before).empty());
    ASSERT_EQ(sliding.cover_extremities(0.05, {}), 2);
    const SlidingQuads::State covered = sliding.state();
    using Regions = std::vector<std::vector<int>>;
    const Regions regions = sliding.regions_moved_since(before);
    ASSERT_EQ(regions.size(), 2U);
    for (const std::vector<int>& region : regions) EXPECT_GE(region.size(), 4U);
    sliding.restore(before, regions[0]);
    EXPECT_EQ(sliding.regions_moved_since(before), Regions{regions[1]});
    EXPECT_EQ(sliding.regions_moved_since(covered), Regions{regions[0]});
}

TEST(SlidingQuads, TheQuadsAroundAQuadAreThoseThatItReaches) {
    const Grid grid(landscape(12, flat), 9, 0);
    const SlidingQuads sliding = grid.sliding({{grid.mesh.V, 1}});
    const int middle = 4 * 9 + 4;
    EXPECT_EQ(sliding.quads_around(middle, 0), std::vector<int>{middle});
    for (const int reach : {1, 2, 3}) {
        std::vector<int> expected;
        for (int i = 4 - reach; i <= 4 + reach; ++i) {
            for (int j = 4 - reach; j <= 4 + reach; ++j) expected.push_back(9 * i + j);
        }
        EXPECT_EQ(sliding.quads_around(middle, reach), expected);
    }
    EXPECT_EQ(sliding.quads_around(0, 1), (std::vector<int>{0, 1, 9, 10}));
}

TEST(CutQuads, CutsAlongTheShorterDiagonal) {
    Positions X(5, 3);
    X << 0, 0, 0, 3, 0, 0, 4, 1, 0, 1, 1, 0, 9, 9, 9;
    Quads Q(2, 4);
    Q << 0, 1, 2, 3, 1, 2, 3, 0;
    Triangles expected(4, 3);
    expected << 1, 2, 3, 1, 3, 0, 1, 2, 3, 1, 3, 0;
    EXPECT_EQ(cut_quads(Q, X), expected);
}

TEST(RelaxQuads, CoversATipAndLeavesTheRestSquare) {
    int tip = -1;
    const Grid grid = spiked(&tip);
    const MemorySequence sequence(grid.mesh.F, {grid.mesh.V});
    Grid after = grid;
    after.quads = relax_quads(grid.quads, {{sequence, grid.mesh.V}}, grid.topology, grid.metric,
                              {.distance_limit = 0.4}, {});
    grid.expect_kept(after.quads);
    // The spike is 0.72 edges high; gaps are closed to about 0.45.
    EXPECT_LT(after.farthest(), 0.5 / 6);
    EXPECT_GT(grid.least_jacobian(after.quads, grid.mesh.V), 0.15);
    // The spike is one vertex of quads that are a sixth wide: those two away stay squares, nearly.
    for (const Eigen::Index quad : {0, 5, 30, 35}) {
        EXPECT_LT(quad_cost(grid.corners(after.quads, grid.mesh.V, quad), FoldBarrier{}), 0.01);
    }
}

/// How far the input is in the end, in a frame that alone of twelve shows a spike, from quads that
/// `relax` has slid.
double farthest_from_spike(decltype(relax_quads)& relax, const RelaxOptions& options) {
    constexpr std::size_t spiked_frame = 7;
    int tip = -1;
    const Grid grid = spiked(&tip);
    Positions flattened = grid.mesh.V;
    flattened(tip, 2) = 0;
    std::vector<Positions> frames(12, flattened);
    frames[spiked_frame] = grid.mesh.V;
    const MemorySequence sequence(grid.mesh.F, frames);
    Grid after = grid;
    after.quads =
        relax(grid.quads, {{sequence, flattened}}, grid.topology, grid.metric, options, {});
    grid.expect_kept(after.quads);
    EXPECT_GT(grid.least_jacobian(after.quads, flattened), 0.1);
    return after.farthest();
}

TEST(RelaxQuads, SettlesInFramesBetweenTheSampledOnes) {
    const auto farthest = [](int settling_frames) {
        return farthest_from_spike(relax_quads,
                                   {.sampled_frames = 3, .settling_frames = settling_frames});
    };
    // Of twelve frames three are 0, 4 and 8; four would be 0, 3, 6 and 9.
    for (const int too_few : {0, 3, 4}) EXPECT_GT(farthest(too_few), 0.6 / 6);
    EXPECT_LT(farthest(12), 0.5 / 6);
}

TEST(SettleInMoreFrames, ClosesAGapThatOnlyOneOfThemShows) {
    const auto farthest = [](int watched_frames) {
        return farthest_from_spike(settle_in_more_frames,
                                   {.watched_frames = watched_frames, .shaped_frames = 3});
    };
    // Of twelve frames four are 0, 3, 6 and 9, shapes count in three of these; five would be 0, 2,
    // 4, 7 and 9.
    for (const int too_few : {0, 3, 4}) EXPECT_GT(farthest(too_few), 0.6 / 6);
    for (const int enough : {5, 12}) EXPECT_LT(farthest(enough), 0.5 / 6);
}

TEST(SettleInMoreFrames, LooksAtNoMoreFramesThanItIsTold) {
    // Of eight frames five are 0, 1, 3, 4 and 6, shapes count in three of these; three of all eight
    // would be 0, 2 and 5.
    const Grid grid(landscape(14, flat), 7, 0.45);
    const auto settled = [&](const std::vector<int>& sheared_frames) {
        std::vector<Positions> frames(8, grid.mesh.V);
        for (const int f : sheared_frames) {
            frames[static_cast<std::size_t>(f)] = sheared(grid.mesh.V, 2);
        }
        const MemorySequence sequence(grid.mesh.F, frames);
        return settle_in_more_frames(grid.quads, {{sequence, grid.mesh.V}}, grid.topology,
                                     grid.metric, {.watched_frames = 5, .shaped_frames = 3}, {})
            .vertex;
    };
    EXPECT_EQ(settled({2, 5, 7}), settled({}));
    EXPECT_NE(settled({4}), settled({}));
}

TEST(SettleInMoreFrames, TheSameInputGivesTheSameMeshOnAnyNumberOfThreads) {
    int tip = -1;
    const Grid grid = spiked(&tip);
    std::vector<Positions> frames;
    for (int f = 0; f < 20; ++f) {
        frames.push_back(sheared(grid.mesh.V, 0.04 * f - 0.4));
        frames.back()(tip, 2) *= 0.5 + 0.2 * (f % 7);
    }
    const MemorySequence sequence(grid.mesh.F, frames);
    const auto settled = [&](int threads) {
        Context context;
        context.threads = threads;
        return settle_in_more_frames(
                   grid.quads, {{sequence, frames.front()}}, grid.topology, grid.metric,
                   {.watched_frames = 20, .watched_rounds = 3, .drags_patches = true}, context)
            .vertex;
    };
    const std::vector<SurfacePoint> alone = settled(1);
    EXPECT_NE(alone, grid.quads.vertex);
    for (const int threads : {2, 8}) EXPECT_EQ(settled(threads), alone);
}

TEST(SettleInMoreFrames, CountsShapesInTheShapedFramesAlone) {
    const Grid grid(landscape(14, flat), 7, 0.45);
    // What is watched beside these is sheared so much that squares would be far from squares.
    std::vector<Positions> frames(8, grid.mesh.V);
    const MemorySequence straight(grid.mesh.F, frames);
    for (const int f : {1, 3, 5, 7}) frames[static_cast<std::size_t>(f)] = sheared(grid.mesh.V, 2);
    const MemorySequence mixed(grid.mesh.F, frames);
    const auto settled = [&](const MemorySequence& sequence) {
        return settle_in_more_frames(grid.quads, {{sequence, grid.mesh.V}}, grid.topology,
                                     grid.metric, {.watched_frames = 8, .shaped_frames = 4}, {});
    };
    const QuadMesh quads = settled(mixed);
    EXPECT_EQ(quads.vertex, settled(straight).vertex);
    EXPECT_LT(grid.cost(quads, grid.mesh.V), 0.2 * grid.cost(grid.quads, grid.mesh.V));
}

TEST(SettleInMoreFrames, CountsTheReferenceNoMoreThanTheRest) {
    // Two poses that want different quads: the ends of the grid stay straight.
    const Grid grid(landscape(14, hill), 7, 0.3);
    std::vector<Positions> frames(6, sheared(grid.mesh.V, 0.5));
    for (const int f : {1, 3, 5}) {
        frames[static_cast<std::size_t>(f)] = sheared(grid.mesh.V, -0.5);
    }
    const MemorySequence sequence(grid.mesh.F, frames);
    const auto cost_of_first = [&](decltype(relax_quads)& relax, int reference) {
        const QuadMesh quads = relax(grid.quads, {{sequence, sequence.read_frame(reference)}},
                                     grid.topology, grid.metric,
                                     {.sampled_frames = 6,
                                      .settling_frames = 6,
                                      .watched_frames = 6,
                                      .watched_rounds = 40,
                                      .reference_frame = reference,
                                      .rounds = 40},
                                     {});
        return grid.cost(quads, frames[0]);
    };
    const double preferred = cost_of_first(settle_in_more_frames, 0);
    EXPECT_NEAR(preferred, cost_of_first(settle_in_more_frames, 1), 0.01 * preferred);
    EXPECT_LT(cost_of_first(relax_quads, 0), 0.95 * cost_of_first(relax_quads, 1));
}

TEST(RelaxQuads, LooksAtTheFirstFrameWhateverTheReference) {
    int tip = -1;
    const Grid grid = spiked(&tip);
    Positions flattened = grid.mesh.V;
    flattened(tip, 2) = 0;
    // The spike is in the first frame alone.
    std::vector<Positions> frames(12, flattened);
    frames[0] = grid.mesh.V;
    const MemorySequence sequence(grid.mesh.F, frames, flattened);
    for (const std::optional<int> reference :
         {std::optional<int>(4), std::optional<int>(5), std::optional<int>()}) {
        Grid after = grid;
        after.quads = relax_quads(grid.quads, {{sequence, flattened}}, grid.topology, grid.metric,
                                  {.sampled_frames = 3, .reference_frame = reference}, {});
        grid.expect_kept(after.quads);
        EXPECT_LT(after.farthest(), 0.5 / 6) << "reference " << reference.value_or(-1);
    }
}

TEST(RelaxQuads, ImprovesAllFramesTogetherAndKeepsTheMesh) {
    const Grid grid(landscape(14, hill), 7, 0.45);
    std::vector<Positions> frames;
    for (int f = 0; f < 5; ++f) frames.push_back(sheared(grid.mesh.V, 0.3 * f - 0.6));
    const MemorySequence sequence(grid.mesh.F, frames);
    const QuadMesh after = relax_quads(grid.quads, {{sequence, sequence.read_frame(2)}},
                                       grid.topology, grid.metric, {.reference_frame = 2}, {});
    grid.expect_kept(after);
    double cost_before = 0;
    double cost_after = 0;
    for (const Positions& frame : frames) {
        cost_before += grid.cost(grid.quads, frame);
        cost_after += grid.cost(after, frame);
    }
    EXPECT_LT(cost_after, 0.8 * cost_before);
    EXPECT_GT(grid.least_jacobian(after, frames[2]), 0.15);
}

TEST(RelaxQuads, TheRestShapeCanBeTheReference) {
    Grid grid(landscape(14, hill), 7, 0.1);
    grid.quads.vertex[static_cast<std::size_t>(3 * 8 + 3)] = grid.above(0.61, 0.47);
    ASSERT_LE(grid.least_jacobian(grid.quads, grid.mesh.V), 0);
    const MemorySequence sequence(grid.mesh.F, {sheared(grid.mesh.V, 0.2)}, grid.mesh.V);
    const QuadMesh after =
        relax_quads(grid.quads, {{sequence, sequence.read_rest_shape()}}, grid.topology,
                    grid.metric, {.sampled_frames = 1, .reference_frame = std::nullopt}, {});
    EXPECT_GT(grid.least_jacobian(after, grid.mesh.V), 0);
    grid.expect_kept(after);
}

TEST(RelaxQuads, TheSameInputGivesTheSameMesh) {
    const Grid grid(landscape(14, hill), 7, 0.45);
    const MemorySequence sequence(grid.mesh.F, {grid.mesh.V, sheared(grid.mesh.V, 0.5)});
    Context one;
    one.threads = 1;
    const QuadMesh a = relax_quads(grid.quads, {{sequence, sequence.read_frame(0)}}, grid.topology,
                                   grid.metric, {}, one);
    const QuadMesh b = relax_quads(grid.quads, {{sequence, sequence.read_frame(0)}}, grid.topology,
                                   grid.metric, {}, {});
    for (std::size_t v = 0; v < a.vertex.size(); ++v) {
        EXPECT_EQ(a.vertex[v].triangle, b.vertex[v].triangle);
        EXPECT_EQ(a.vertex[v].barycentric, b.vertex[v].barycentric);
    }
}

}  // namespace
}  // namespace kinequad
