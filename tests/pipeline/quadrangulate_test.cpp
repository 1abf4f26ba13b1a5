#include "kinequad/pipeline/quadrangulate.h"

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <vector>

#include "kinequad/core/error.h"
#include "kinequad/extract/verify_quad_mesh.h"
#include "kinequad/io/memory_sequence.h"
#include "kinequad/synth/synthesize_creature.h"
#include "kinequad/transfer/transfer.h"
#include "stretched_torus.h"
#include "support/shapes.h"

namespace kinequad {
namespace {

TEST(Quadrangulate, TorusStaysATorus) {
    const MemorySequence source = test::stretched_torus(3, 0.1, "torus");
    const Result result = quadrangulate(source, {}, test::options_with(600), Context{});
    const QuadMeshReport report = verify_quad_mesh(result.quads, result.topology);
    EXPECT_TRUE(report.valid());
    EXPECT_EQ(report.euler_characteristic, 0);
    EXPECT_NEAR(report.vertices, 600, 30);
    EXPECT_EQ(result.field.index.sum(), 0);
}

TEST(Quadrangulate, StagesComeInOrderAndAreTimed) {
    const MemorySequence source = test::stretched_torus(2, 0.1, "torus");
    std::vector<std::string> seen;
    const Result result =
        quadrangulate(source, {}, test::options_with(400), Context{},
                      [&](std::string_view stage, const Result&) { seen.emplace_back(stage); });
    std::vector<std::string> timed;
    for (const StageTime& time : result.times) timed.push_back(time.stage);
    EXPECT_EQ(seen, timed);
    EXPECT_EQ(seen.front(), "check");
}

TEST(Quadrangulate, WithoutAnimationOtherFramesDoNotMatter) {
    Options options = test::options_with(400);
    options.alpha = 0;
    const MemorySequence moving = test::stretched_torus(5, 0.1, "torus");
    const MemorySequence still(moving.triangles(), {moving.read_frame(0)});
    const Result a = quadrangulate(moving, {}, options, Context{});
    const Result b = quadrangulate(still, {}, options, Context{});
    EXPECT_EQ(a.field.angle, b.field.angle);
    EXPECT_EQ(a.quads.Q, b.quads.Q);
}

TEST(Quadrangulate, MeanMetricDoesNotDependOnTheOrderOfTheFrames) {
    const MemorySequence forward = test::stretched_torus(4, 0.1, "torus");
    std::vector<Positions> frames;
    for (int j = 3; j >= 0; --j) frames.push_back(forward.read_frame(j));
    const MemorySequence backward(forward.triangles(), frames);
    const Result a = quadrangulate(forward, {}, test::options_with(400), Context{});
    const Result b = quadrangulate(backward, {}, test::options_with(400), Context{});
    EXPECT_TRUE(a.domain.metric.edge_length.isApprox(b.domain.metric.edge_length, 1e-12));
    EXPECT_EQ(a.field.index, b.field.index);
}

TEST(Quadrangulate, NamesTheInputThatIsNoManifold) {
    Triangles F(3, 3);
    F << 0, 1, 2, 1, 0, 3, 0, 1, 4;
    const MemorySequence source(F, {Positions::Random(5, 3)}, {}, "fin.obj");
    try {
        quadrangulate(source, {}, test::options_with(100), Context{});
        FAIL() << "accepted";
    } catch (const InputError& error) {
        EXPECT_EQ(error.code(), ExitCode::invalid_mesh);
        EXPECT_EQ(std::string(error.what()).rfind("fin.obj: 1 non-manifold edge: 0-1", 0), 0U)
            << error.what();
    }
}

TEST(Quadrangulate, StopsWhenAsked) {
    std::atomic<bool> cancel{true};
    Context context;
    context.cancel = &cancel;
    EXPECT_THROW(
        quadrangulate(test::stretched_torus(2, 0.1, "torus"), {}, test::options_with(400), context),
        Cancelled);
}

/// Quads of a cube of 12 triangles, edge length 2, with some of its edges as features.
Result quads_of_cube(const Options& options) {
    const TriangleMesh mesh = test::cube(1);
    return quadrangulate(MemorySequence(mesh.F, {mesh.V}), {}, options, Context{});
}

TEST(Quadrangulate, SharpEdgesOfACubeAreKept) {
    Options options = test::options_with(300);
    options.feature_angle = 40;
    const Result result = quads_of_cube(options);
    const TriangleMesh mesh = test::cube(1);
    const Positions X = quad_positions(result.quads, mesh.V, mesh.F);
    EXPECT_EQ(result.map.feature_edges, result.domain.feature_edges);
    // Coordinates at +-1 count the sides of the cube that a point lies on.
    int corners = 0;
    std::vector<int> sides;
    for (Eigen::Index v = 0; v < X.rows(); ++v) {
        sides.push_back(static_cast<int>((X.row(v).array().abs() > 1 - 1e-9).count()));
        EXPECT_GE(sides.back(), 1);
        corners += sides.back() == 3 ? 1 : 0;
    }
    EXPECT_EQ(corners, 8);
    // No quad reaches over an edge: all its corners lie on one side of the cube.
    for (Eigen::Index q = 0; q < result.quads.Q.rows(); ++q) {
        Eigen::Array<double, 1, 3> sum = Eigen::Array<double, 1, 3>::Zero();
        for (int k = 0; k < 4; ++k) sum += X.row(result.quads.Q(q, k)).array();
        EXPECT_NEAR(sum.abs().maxCoeff(), 4, 1e-8);
    }
}

TEST(Quadrangulate, FeaturesCanBeNamed) {
    const TriangleMesh mesh = test::cube(1);
    const auto corner = [&](double x, double y, double z) {
        Eigen::Index v = 0;
        (mesh.V.rowwise() - Eigen::RowVector3d(x, y, z)).rowwise().squaredNorm().minCoeff(&v);
        return static_cast<int>(v);
    };
    Options options = test::options_with(200);
    options.features = {{corner(-1, -1, -1), corner(1, -1, -1)}};
    const Result result = quads_of_cube(options);
    EXPECT_FALSE(result.map.feature_edges.empty());
    EXPECT_EQ(result.map.feature_edges, result.domain.feature_edges);
    options.features = {{corner(-1, -1, -1), corner(1, 1, 1)}};
    EXPECT_THROW(quads_of_cube(options), InputError);
}

TEST(Quadrangulate, ASingleTriangleIsEnough) {
    Triangles F(1, 3);
    F << 0, 1, 2;
    Positions V(3, 3);
    V << -1, 0, 0, 1, 0, 0, 0, 1.5, 0;
    const MemorySequence source(F, {V});
    Options options = test::options_with(100);
    EXPECT_GT(quadrangulate(source, {}, options, Context{}).quads.Q.rows(), 50);
    options.symmetry = SymmetryMode::field;
    EXPECT_GT(quadrangulate(source, {}, options, Context{}).quads.Q.rows(), 50);
    // Its half has too sharp a corner for crosses along both sides.
    options.symmetry = SymmetryMode::exact;
    try {
        quadrangulate(source, {}, options, Context{});
        FAIL();
    } catch (const GridMapError& error) {
        EXPECT_FALSE(error.depends_on_density());
        EXPECT_NE(std::string(error.what()).find("--symmetry field"), std::string::npos);
    }
}

}  // namespace
}  // namespace kinequad
