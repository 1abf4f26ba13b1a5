#include "kinequad/measure/measure_sequence.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "kinequad/core/error.h"
#include "kinequad/io/memory_sequence.h"
#include "kinequad/io/read_polygon_mesh.h"
#include "kinequad/measure/format_metrics.h"
#include "kinequad/measure/triangulation.h"
#include "kinequad/transfer/bind_to_surface.h"
#include "quad_grid.h"
#include "support/data.h"
#include "support/shapes.h"

namespace kinequad {
namespace {

/// A square that rises to a ridge, higher from frame to frame.
MemorySequence rising_square(int frames) {
    const TriangleMesh square = test::square(20);
    std::vector<Positions> all;
    for (int j = 0; j < frames; ++j) {
        Positions V = square.V;
        for (Eigen::Index i = 0; i < V.rows(); ++i)
            V(i, 2) = 0.1 * j * (0.5 - std::abs(V(i, 0) - 0.5));
        all.push_back(V);
    }
    return MemorySequence(square.F, all);
}

QuadSequence follow_grid(const MemorySequence& input, int n) {
    const test::QuadGrid grid = test::quad_grid(n);
    const auto vertices = bind_to_surface(grid.X, input.read_frame(0), input.triangles());
    return follow_surface(make_polygons(grid.Q), vertices, input.triangles());
}

TEST(MeasureSequence, MeasuresEveryFrame) {
    const MemorySequence input = rising_square(4);
    const SequenceMetrics m = measure_sequence(input, follow_grid(input, 5));
    ASSERT_EQ(m.frames.size(), 4u);
    EXPECT_EQ(m.quads.quads, 25);
    EXPECT_EQ(m.input.triangles, 800);
    EXPECT_NEAR(m.frames[0].distance.hausdorff_percent(), 0, 1e-10);
    for (int j = 1; j < 4; ++j) {
        const FrameMetrics& frame = m.frames[static_cast<std::size_t>(j)];
        EXPECT_EQ(frame.frame, j);
        EXPECT_EQ(frame.flipped_quads, 0);
        EXPECT_NEAR(frame.shape.angle_deviation_mean, 0, 1e-10);
        // The grid's middle column cuts the ridge's tip off, at 0.4 of its 0.5.
        const double height = 0.1 * j * 0.1;
        const double diagonal = bounding_box_diagonal(input.read_frame(j));
        EXPECT_NEAR(frame.distance.hausdorff_percent(), 100 * height / diagonal, 1e-9);
    }
    EXPECT_TRUE(std::isnan(m.stretch_alignment_degrees));
}

TEST(MeasureSequence, FollowsAStretchOfTheInput) {
    const MemorySequence input = rising_square(3);
    const QuadSequence quads = follow_grid(input, 8);
    const Positions V = input.read_frame(0);
    const Topology topology = build_topology(input.triangles(), input.vertex_count());
    const StretchReference reference{V, input.triangles(),
                                     triangle_sides(topology, metric_of(topology, V)),
                                     quads.read_frame(0, V), quads.faces};
    MeasureOptions options;
    options.measure_distance = false;
    const SequenceMetrics m = measure_sequence(input, quads, reference, options);
    EXPECT_NEAR(m.stretch_alignment_degrees, 0, 1e-5);
    EXPECT_FALSE(to_json(m).at("stretch_alignment_degrees").is_null());
    EXPECT_TRUE(to_json(m).at("hausdorff_percent").is_null());
}

TEST(MeasureSequence, MeasuresSeveralMeshesAsIfEachWereAlone) {
    const MemorySequence input = rising_square(4);
    const std::vector<QuadSequence> grids = {follow_grid(input, 5), follow_grid(input, 9)};
    const Topology topology = build_topology(input.triangles(), input.vertex_count());
    const Positions V = input.read_frame(0);
    std::vector<MeasuredQuads> meshes;
    for (const QuadSequence& grid : grids) {
        meshes.push_back({grid, StretchReference{V, input.triangles(),
                                                 triangle_sides(topology, metric_of(topology, V)),
                                                 grid.read_frame(0, V), grid.faces}});
    }
    const std::vector<SequenceMetrics> together = measure_sequences(input, meshes);
    ASSERT_EQ(together.size(), 2u);
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const SequenceMetrics alone = measure_sequence(input, meshes[i].quads, meshes[i].reference);
        EXPECT_EQ(to_json(together[i]).dump(), to_json(alone).dump());
    }
}

TEST(MeasureSequence, MeasuresEveryKthFrame) {
    const MemorySequence input = rising_square(7);
    MeasureOptions options;
    options.frame_step = 3;
    const QuadSequence quads = follow_grid(input, 5);
    const SequenceMetrics all = measure_sequence(input, quads);
    const SequenceMetrics some = measure_sequence(input, quads, {}, options);
    ASSERT_EQ(some.frames.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(some.frames[i].frame, static_cast<int>(3 * i));
        EXPECT_EQ(some.frames[i].distance.hausdorff_percent(),
                  all.frames[3 * i].distance.hausdorff_percent());
    }
}

TEST(MeasureSequence, GivesForeignFramesTheSameMeasures) {
    const MemorySequence input = rising_square(3);
    const QuadSequence quads = follow_grid(input, 5);
    std::vector<Positions> frames;
    for (int j = 0; j < 3; ++j) frames.push_back(quads.read_frame(j, input.read_frame(j)));
    Triangles any(1, 3);
    any << 0, 1, 2;
    const MemorySequence foreign(any, frames);
    EXPECT_EQ(to_json(measure_sequence(input, quads)),
              to_json(measure_sequence(input, follow_frames(quads.faces, foreign))));
}

TEST(MeasureSequence, CountsFlippedQuads) {
    const MemorySequence input = rising_square(1);
    test::QuadGrid grid = test::quad_grid(4);
    grid.Q.row(5).reverseInPlace();
    const SequenceMetrics m = measure_sequence(input, stand_still(make_polygons(grid.Q), grid.X));
    EXPECT_EQ(m.frames[0].flipped_quads, 1);
    for (Eigen::Index q = 0; q < grid.Q.rows(); ++q) grid.Q.row(q).reverseInPlace();
    const SequenceMetrics turned =
        measure_sequence(input, stand_still(make_polygons(grid.Q), grid.X));
    EXPECT_EQ(turned.frames[0].flipped_quads, 1) << "all others are turned over together";
}

TEST(MeasureSequence, SumsUpMeanAndWorst) {
    const MemorySequence input = rising_square(3);
    const SequenceMetrics m = measure_sequence(input, follow_grid(input, 5));
    const nlohmann::json json = to_json(m);
    ASSERT_EQ(json.at("frames").size(), 3u);
    double sum = 0;
    for (const double value : json.at("hausdorff_percent")) sum += value;
    EXPECT_NEAR(json.at("mean").at("hausdorff_percent").get<double>(), sum / 3, 1e-12);
    EXPECT_EQ(json.at("worst").at("hausdorff_percent").at("frame"), 2);
    EXPECT_EQ(json.at("worst").at("hausdorff_percent").at("value"),
              json.at("hausdorff_percent").at(2));
    EXPECT_EQ(json.at("vertices"), 36);
    EXPECT_EQ(json.at("singular_vertices"), 4);
    EXPECT_EQ(json.at("input").at("euler_characteristic"), 1);
    const std::string table = format_metrics_table(m);
    for (const char* row :
         {"singular vertices", "11.11 %", "Hausdorff distance", "over 3 frames"}) {
        EXPECT_NE(table.find(row), std::string::npos) << row << " is missing in\n" << table;
    }
}

TEST(MeasureSequence, DoesNotDependOnTheNumberOfThreads) {
    const MemorySequence input = rising_square(3);
    const QuadSequence quads = follow_grid(input, 7);
    Context one;
    one.threads = 1;
    Context eight;
    eight.threads = 8;
    EXPECT_EQ(to_json(measure_sequence(input, quads, {}, {}, one)).dump(),
              to_json(measure_sequence(input, quads, {}, {}, eight)).dump());
}

TEST(MeasureSequence, StopsWhenAsked) {
    const MemorySequence input = rising_square(3);
    std::atomic<bool> cancel = false;
    Context context;
    context.cancel = &cancel;
    context.progress = [&](std::string_view, double fraction) { cancel = fraction > 0.3; };
    EXPECT_THROW(measure_sequence(input, follow_grid(input, 5), {}, {}, context), Cancelled);
}

TEST(MeasureSequence, RefusesWhatDoesNotFit) {
    const MemorySequence input = rising_square(3);
    const test::QuadGrid grid = test::quad_grid(3);
    EXPECT_THROW(measure_sequence(input, stand_still(make_polygons(grid.Q), grid.X)), InputError);
    MeasureOptions options;
    options.frame_step = 0;
    EXPECT_THROW(measure_sequence(input, follow_grid(input, 3), {}, options), InputError);
    const MemorySequence single = rising_square(1);
    Positions X = grid.X;
    X(2, 1) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(measure_sequence(single, stand_still(make_polygons(grid.Q), X)), InputError);
    EXPECT_THROW(measure_sequence(single, stand_still(make_polygons(grid.Q), grid.X.topRows(3))),
                 InputError);
}

TEST(MeasureSequence, AgreesWithAnIndependentProgramOnAnArtistsQuads) {
    KINEQUAD_REQUIRE_DATA();
    const auto folder = test::data_folder() / "sequences";
    const PolygonMesh quads = read_polygon_mesh(folder / "makehuman_body_quads.obj");
    const PolygonMesh input = read_polygon_mesh(folder / "makehuman_walk.obj");
    const MemorySequence pose(triangulate_for_measuring(input.faces, input.V).F, {input.V});
    const SequenceMetrics m = measure_sequence(pose, stand_still(quads.faces, quads.V));
    EXPECT_EQ(m.quads.vertices, 13380);
    EXPECT_EQ(m.quads.quads, 13378);
    EXPECT_EQ(m.quads.irregular_vertices, 320);
    EXPECT_EQ(m.quads.euler_characteristic, 2);
    const QuadShapeMetrics& shape = m.frames.at(0).shape;
    EXPECT_NEAR(shape.angle_deviation_mean, 12.169, 5.1e-4);
    EXPECT_NEAR(shape.angle_deviation_max, 78.38, 5.1e-3);
    EXPECT_NEAR(shape.scaled_jacobian_min, 0.0554, 5.1e-5);
    EXPECT_NEAR(shape.scaled_jacobian_mean, 0.9253, 5.1e-5);
    EXPECT_EQ(shape.folded_quads, 0);
    EXPECT_EQ(m.frames.at(0).flipped_quads, 0);
}

}  // namespace
}  // namespace kinequad
