#include "kinequad/extract/mirrored_quads.h"

#include <gtest/gtest.h>

#include <utility>

#include "kinequad/extract/quad_topology.h"
#include "kinequad/extract/split_rows.h"

namespace kinequad {
namespace {

/// A strip of `columns` x `rows` quads; its left side, column 0, is the line of symmetry, and with
/// `is_tube` its right side as well.
struct Half {
    QuadMesh quads;
    std::vector<char> is_on_curve;
};

Half half_grid(int columns, int rows, bool is_tube) {
    Half half;
    const auto vertex = [&](int x, int y) { return y * (columns + 1) + x; };
    half.quads.Q.resize(columns * rows, 4);
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
            half.quads.Q.row(y * columns + x) << vertex(x, y), vertex(x + 1, y),
                vertex(x + 1, y + 1), vertex(x, y + 1);
        }
    }
    for (int y = 0; y <= rows; ++y) {
        for (int x = 0; x <= columns; ++x) {
            half.quads.vertex.push_back({x, Vector3(1, 0, 0)});
            half.is_on_curve.push_back(x == 0 || (is_tube && x == columns) ? 1 : 0);
        }
    }
    return half;
}

TEST(MirroredQuads, JoinAlongTheLine) {
    const Half half = half_grid(3, 4, false);
    const QuadMesh whole = join_mirrored_quads(half.quads, half.quads.vertex, half.is_on_curve);
    const QuadTopology topology =
        build_quad_topology(whole.Q, static_cast<int>(whole.vertex.size()));
    EXPECT_EQ(topology.quad_count, 24);
    EXPECT_EQ(topology.vertex_count, 2 * 20 - 5);
    EXPECT_EQ(count_irregular_vertices(topology), 4) << "the corners of the sheet";
    const MirrorReport report = verify_mirror(whole);
    EXPECT_TRUE(report.valid());
    EXPECT_EQ(report.fixed_vertices, 5);
}

TEST(MirroredQuads, ASheetWithTwoLinesBecomesATube) {
    const Half half = half_grid(3, 4, true);
    const QuadMesh whole = join_mirrored_quads(half.quads, half.quads.vertex, half.is_on_curve);
    EXPECT_EQ(count_irregular_vertices(
                  build_quad_topology(whole.Q, static_cast<int>(whole.vertex.size()))),
              0);
    EXPECT_TRUE(verify_mirror(whole).valid());
}

TEST(VerifyMirror, FindsWhatIsNoMirrorImage) {
    const Half half = half_grid(3, 4, false);
    QuadMesh whole = join_mirrored_quads(half.quads, half.quads.vertex, half.is_on_curve);
    std::swap(whole.mirror[1], whole.mirror[2]);
    MirrorReport report = verify_mirror(whole);
    EXPECT_GT(report.broken_vertices, 0);
    EXPECT_GT(report.broken_quads, 0);
    whole = join_mirrored_quads(half.quads, half.quads.vertex, half.is_on_curve);
    whole.mirror[1] = 1;
    report = verify_mirror(whole);
    EXPECT_FALSE(report.valid());
    EXPECT_EQ(report.loose_fixed_vertices, 1);
    whole.mirror.pop_back();
    EXPECT_FALSE(verify_mirror(whole).valid());
}

TEST(SplitRows, KeepsTheTwoLinesOfATubeTwoQuadsApart) {
    const Half half = half_grid(1, 4, true);
    int middles = 0;
    const QuadMesh split = split_rows_across_curve(
        half.quads, half.is_on_curve, [&](const std::vector<SurfacePoint>& points, bool) {
            ++middles;
            return points.front();
        });
    EXPECT_EQ(split.Q.rows(), 8);
    EXPECT_EQ(middles, 5);
    std::vector<char> is_on_curve = half.is_on_curve;
    is_on_curve.resize(split.vertex.size(), 0);
    const QuadMesh whole = join_mirrored_quads(split, split.vertex, is_on_curve);
    EXPECT_EQ(count_irregular_vertices(
                  build_quad_topology(whole.Q, static_cast<int>(whole.vertex.size()))),
              0);
    EXPECT_TRUE(verify_mirror(whole).valid());
}

}  // namespace
}  // namespace kinequad
