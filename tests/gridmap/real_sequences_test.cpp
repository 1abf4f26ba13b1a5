#include <gtest/gtest.h>

#include "kinequad/extract/extract_quads.h"
#include "kinequad/extract/verify_quad_mesh.h"
#include "kinequad/field/compute_cross_field.h"
#include "kinequad/gridmap/compute_grid_map.h"
#include "kinequad/io/open_sequence.h"
#include "support/data.h"

namespace kinequad {
namespace {

class RealGridMap : public testing::TestWithParam<std::tuple<const char*, int>> {};

TEST_P(RealGridMap, IsValidAndOfTheWantedSize) {
    KINEQUAD_REQUIRE_DATA();
    const auto& [name, vertices] = GetParam();
    const auto frames =
        open_sequence((test::data_folder() / "sequences" / (std::string(name) + ".obj")).string());
    const Topology topology = build_topology(frames->triangles(), frames->vertex_count());
    const IntrinsicMetric metric = metric_of(topology, frames->read_frame(0));
    const double h = edge_length_for(topology, metric, vertices);
    const CrossField field = compute_cross_field(topology, metric, {}, {.edge_length = h}, {});
    const GridMap map =
        compute_grid_map(topology, metric, field, {.vertex_count = vertices}, Context{});
    EXPECT_TRUE(verify_grid_map(map).valid());
    const QuadMesh quads = extract_quads(map, Context{});
    const QuadMeshReport report = verify_quad_mesh(quads, topology);
    EXPECT_TRUE(report.valid());
    EXPECT_NEAR(report.vertices, vertices, 0.05 * vertices);
}

INSTANTIATE_TEST_SUITE_P(Slow, RealGridMap,
                         testing::Combine(testing::Values("samba", "horse-gallop"),
                                          testing::Values(5200, 2000)),
                         [](const auto& info) {
                             std::string name = std::get<0>(info.param);
                             std::erase(name, '-');
                             return name + "_" + std::to_string(std::get<1>(info.param));
                         });

}  // namespace
}  // namespace kinequad
