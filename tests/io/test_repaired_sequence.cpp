#include <gtest/gtest.h>

#include "io_support.h"
#include "kinequad/io/memory_sequence.h"
#include "kinequad/io/repaired_sequence.h"
#include "kinequad/mesh/topology.h"

namespace kinequad::test {
namespace {

TEST(RepairedSequence, MendsAllFramesAlike) {
    // A bow tie at vertex 0, one of its wings turned over by a neighbour, and vertex 6 unused.
    Triangles F(3, 3);
    F << 0, 1, 2, 1, 2, 5, 0, 3, 4;
    Positions first(7, 3);
    first << 0, 0, 0, 1, 0, 0, 1, 1, 0, -1, 0, 0, -1, -1, 0, 2, 1, 1, 9, 9, 9;
    const Positions second = 2 * first;
    const MemorySequence source(F, {first, second}, 3 * first);
    const RepairedSequence repaired(source, Context{});
    EXPECT_EQ(repaired.vertex_count(), 8);
    EXPECT_EQ(repaired.frame_count(), 2);
    ASSERT_EQ(repaired.actions().size(), 3U) << "vertex 6, the wing and the bow tie";
    EXPECT_NE(repaired.actions()[0].find("without triangles: 6"), std::string::npos);
    EXPECT_EQ(repaired.read_frame(1).row(7), second.row(0));
    EXPECT_EQ(repaired.read_frame(1).topRows(7), second);
    EXPECT_EQ(repaired.read_rest_shape().row(7), 3 * first.row(0));
    EXPECT_LT(repaired.input_triangles().maxCoeff(), 7);
    EXPECT_NO_THROW(build_topology(repaired.triangles(), repaired.vertex_count()));
}

TEST(RepairedSequence, TakesForFlatOnlyWhatIsFlatInEveryFrame) {
    // Vertex 4 lies on the edge 0-1 in the first frame, not in the second.
    Triangles F(4, 3);
    F << 0, 4, 2, 4, 1, 2, 0, 1, 4, 1, 0, 3;
    Positions V(5, 3);
    V << 0, 0, 0, 2, 0, 0, 1, 2, 0, 1, -2, 0, 1, 0, 0;
    Positions bent = V;
    bent(4, 2) = 0.5;
    const MemorySequence moving(F, {V, bent});
    EXPECT_EQ(RepairedSequence(moving, Context{}).triangles(), F);
    const MemorySequence flat(F, {V, 2 * V});
    const RepairedSequence repaired(flat, Context{});
    EXPECT_NE(repaired.triangles(), F);
    ASSERT_EQ(repaired.actions().size(), 1U);
    EXPECT_NE(repaired.actions()[0].find("triangles without area: 2"), std::string::npos)
        << repaired.actions()[0];
}

}  // namespace
}  // namespace kinequad::test
