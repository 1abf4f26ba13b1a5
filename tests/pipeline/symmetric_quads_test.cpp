#include <gtest/gtest.h>

#include <cmath>

#include "kinequad/core/error.h"
#include "kinequad/extract/quad_topology.h"
#include "kinequad/extract/verify_quad_mesh.h"
#include "kinequad/io/memory_sequence.h"
#include "kinequad/io/open_sequence.h"
#include "kinequad/measure/quad_shape.h"
#include "kinequad/pipeline/make_report.h"
#include "kinequad/pipeline/quadrangulate.h"
#include "kinequad/transfer/transfer.h"
#include "support/data.h"
#include "symmetry/symmetric_shapes.h"

namespace kinequad {
namespace {

/// A symmetric shape that bends to one side more and more: no frame but the first is symmetric.
MemorySequence bending(const TriangleMesh& mesh, int frame_count) {
    std::vector<Positions> frames;
    for (int j = 0; j < frame_count; ++j) {
        Positions V = mesh.V;
        V.col(0).array() += 0.06 * j * V.col(1).array().square();
        frames.push_back(V);
    }
    return {mesh.F, frames};
}

/// A symmetric shape that grows longer: symmetric in every frame.
MemorySequence stretching(const TriangleMesh& mesh) {
    std::vector<Positions> frames;
    for (int j = 0; j < 3; ++j) {
        Positions V = mesh.V;
        V.col(1) *= 1 + 0.2 * j;
        frames.push_back(V);
    }
    return {mesh.F, frames};
}

/// What the report of a run says about its symmetry, in degrees.
double symmetry_error_in_report(const Result& result, const FrameSource& source) {
    PictureOptions pictures;
    pictures.pixels = 4000;
    const Report report =
        make_run_report(result, source, "", SequenceMetrics{}, pictures, Context{});
    return report.comparison.methods.at(0).symmetry_error_degrees;
}

Options options_for(SymmetryMode mode) {
    Options options;
    options.vertices = 700;
    options.symmetry = mode;
    return options;
}

class SymmetricQuads : public testing::Test {
protected:
    SymmetricQuads() : shape_(test::bumpy_ellipsoid(4)), source_(bending(shape_.mesh, 4)) {}

    test::SymmetricShape shape_;
    MemorySequence source_;
};

TEST_F(SymmetricQuads, ExactOnesAreTheirOwnMirrorImage) {
    const Result result =
        quadrangulate(source_, shape_.landmarks, options_for(SymmetryMode::exact), Context{});
    EXPECT_TRUE(verify_quad_mesh(result.quads, result.topology).valid());
    EXPECT_TRUE(verify_mirror(result.quads).valid());
    EXPECT_NEAR(static_cast<double>(result.quads.vertex.size()), 700, 50);
}

TEST_F(SymmetricQuads, OfASymmetricAnimationMirrorInSpace) {
    const MemorySequence source = stretching(shape_.mesh);
    const Result result = quadrangulate(source, {}, options_for(SymmetryMode::exact), Context{});
    const Positions X = quad_positions(result.quads, source.read_frame(2), shape_.mesh.F);
    const double diagonal = bounding_box_diagonal(X);
    for (Eigen::Index v = 0; v < X.rows(); ++v) {
        Vector3 image = X.row(result.quads.mirror[static_cast<std::size_t>(v)]).transpose();
        image[0] = -image[0];
        EXPECT_LT((X.row(v).transpose() - image).norm(), 1e-6 * diagonal);
    }
}

TEST_F(SymmetricQuads, ASymmetricFieldPutsAChainOfEdgesOnTheLine) {
    const MemorySequence source = stretching(shape_.mesh);
    const Result result = quadrangulate(source, {}, options_for(SymmetryMode::field), Context{});
    EXPECT_TRUE(verify_quad_mesh(result.quads, result.topology).valid());
    ASSERT_TRUE(result.field_symmetry);
    EXPECT_LT(result.field_symmetry->mean_degrees, 3);
    const Positions X = quad_positions(result.quads, shape_.mesh.V, shape_.mesh.F);
    const QuadTopology topology = build_quad_topology(result.quads.Q, static_cast<int>(X.rows()));
    const double diagonal = bounding_box_diagonal(X);
    const auto on_line = [&](int v) { return std::abs(X(v, 0)) < 1e-6 * diagonal; };
    int vertices = 0;
    int edges = 0;
    for (int v = 0; v < topology.vertex_count; ++v) vertices += on_line(v) ? 1 : 0;
    for (int e = 0; e < topology.edge_count; ++e) {
        const int h = topology.edge_half_edge[static_cast<std::size_t>(e)];
        edges +=
            on_line(topology.origin[static_cast<std::size_t>(h)]) && on_line(topology.target(h))
                ? 1
                : 0;
    }
    EXPECT_GT(vertices, 20);
    EXPECT_EQ(edges, vertices) << "a closed chain has as many edges as vertices";
}

TEST_F(SymmetricQuads, AreTheSameOnAnyNumberOfThreads) {
    for (const SymmetryMode mode : {SymmetryMode::field, SymmetryMode::exact}) {
        std::vector<QuadMesh> meshes;
        for (const int threads : {1, 2, 8}) {
            Context context;
            context.threads = threads;
            meshes.push_back(
                quadrangulate(source_, shape_.landmarks, options_for(mode), context).quads);
        }
        for (std::size_t i = 1; i < meshes.size(); ++i) {
            EXPECT_EQ(meshes[i].Q, meshes[0].Q);
            EXPECT_EQ(meshes[i].mirror, meshes[0].mirror);
            for (std::size_t v = 0; v < meshes[i].vertex.size(); ++v) {
                EXPECT_EQ(meshes[i].vertex[v].triangle, meshes[0].vertex[v].triangle);
                EXPECT_EQ(meshes[i].vertex[v].barycentric, meshes[0].vertex[v].barycentric);
            }
        }
    }
}

TEST_F(SymmetricQuads, WithoutLandmarksASymmetricPoseIsEnough) {
    const Result result = quadrangulate(source_, {}, options_for(SymmetryMode::exact), Context{});
    EXPECT_EQ(result.symmetry->map.method, "mirror plane");
    EXPECT_TRUE(verify_mirror(result.quads).valid());
}

TEST_F(SymmetricQuads, OfACoarseMeshAreOverARefinedOne) {
    // 32 triangles for 700 quads.
    const test::SymmetricShape coarse = test::bumpy_ellipsoid(1);
    const MemorySequence source = stretching(coarse.mesh);
    for (const SymmetryMode mode : {SymmetryMode::field, SymmetryMode::exact}) {
        const Result result = quadrangulate(source, {}, options_for(mode), Context{});
        ASSERT_TRUE(result.refined);
        EXPECT_TRUE(verify_quad_mesh(result.quads, result.topology).valid());
        EXPECT_LT(symmetry_error_in_report(result, source), 5);
        const Positions X = quad_positions(result.quads, coarse.mesh.V, coarse.mesh.F);
        EXPECT_LT(measure_shape(X, result.quads.Q).angle_deviation_mean, 5);
    }
}

TEST_F(SymmetricQuads, AreRefinedOnlyWhereThatDoublesTheTriangles) {
    const test::SymmetricShape coarse = test::bumpy_ellipsoid(2);
    const MemorySequence source = bending(coarse.mesh, 2);
    const auto triangles = [&](int vertices) {
        Options options = options_for(SymmetryMode::exact);
        options.vertices = vertices;
        options.relax_rounds = 0;
        const Result result = quadrangulate(source, coarse.landmarks, options, Context{});
        return result.refined ? result.refined->F.rows() : coarse.mesh.F.rows();
    };
    EXPECT_EQ(triangles(100), coarse.mesh.F.rows());
    EXPECT_GE(triangles(2000), 2 * coarse.mesh.F.rows());
}

TEST_F(SymmetricQuads, OfACoarseMeshKnowLandmarksOfTheInputOnly) {
    const test::SymmetricShape coarse = test::bumpy_ellipsoid(1);
    Landmarks landmarks = coarse.landmarks;
    landmarks.pairs.front()[0] = static_cast<int>(coarse.mesh.V.rows());
    try {
        quadrangulate(stretching(coarse.mesh), landmarks, options_for(SymmetryMode::exact),
                      Context{});
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("18 vertices"), std::string::npos) << error.what();
    }
}

TEST_F(SymmetricQuads, AreRefusedWhereAPartIsTooSmall) {
    TriangleMesh mesh = shape_.mesh;
    const auto n = static_cast<int>(mesh.V.rows());
    mesh.V.conservativeResize(n + 3, 3);
    mesh.V.bottomRows(3) << -0.1, 0, 3, 0.1, 0, 3, 0, 0.1, 3;
    mesh.F.conservativeResize(mesh.F.rows() + 1, 3);
    mesh.F.bottomRows(1) << n, n + 1, n + 2;
    try {
        quadrangulate(stretching(mesh), {}, options_for(SymmetryMode::field), Context{});
        FAIL();
    } catch (const InputError& error) {
        EXPECT_EQ(error.code(), ExitCode::no_symmetry);
        EXPECT_NE(std::string(error.what()).find("has 1 triangle, too few"), std::string::npos);
    }
}

TEST(SymmetricQuadsOfRealParts, SlowCoverARoosterOfFortyOneParts) {
    KINEQUAD_REQUIRE_DATA();
    const auto frames = open_sequence((test::data_folder() / "sequences" / "chicken.obj").string());
    Options options;
    options.symmetry = SymmetryMode::field;
    options.symmetrisation = Symmetrisation::orbits;
    options.alpha = 0.5;
    options.relax_rounds = 0;
    const Result result = quadrangulate(*frames, {}, options, Context{});
    const QuadMeshReport report = verify_quad_mesh(result.quads, result.topology);
    EXPECT_TRUE(report.valid());
    ASSERT_TRUE(result.field_symmetry);
    EXPECT_LT(result.field_symmetry->mean_degrees, 5.5);
    EXPECT_NEAR(report.vertices, 5200, 260);
}

struct Expected {
    const char* name;
    int singular;
};

class RealMirror : public testing::TestWithParam<Expected> {};

TEST_P(RealMirror, SlowMirrorsCapturedCharacters) {
    KINEQUAD_REQUIRE_DATA();
    const auto frames = open_sequence(
        (test::data_folder() / "sequences" / (std::string(GetParam().name) + ".obj")).string());
    const Landmarks landmarks = read_landmarks(test::data_folder() / "landmarks" /
                                               (std::string(GetParam().name) + ".json"));
    Options options;
    options.vertices = 5200;
    const Result result = quadrangulate(*frames, landmarks, options, Context{});
    EXPECT_TRUE(verify_mirror(result.quads).valid());
    EXPECT_NEAR(static_cast<double>(result.quads.vertex.size()), 5200, 260);
    EXPECT_LE(count_irregular_vertices(build_quad_topology(
                  result.quads.Q, static_cast<int>(result.quads.vertex.size()))),
              GetParam().singular);
}

INSTANTIATE_TEST_SUITE_P(Sequences, RealMirror,
                         testing::Values(Expected{"samba", 52}, Expected{"bouncing", 56},
                                         Expected{"horse-gallop", 86}, Expected{"cat-poses", 130}),
                         [](const auto& info) { return std::to_string(info.index); });

}  // namespace
}  // namespace kinequad
