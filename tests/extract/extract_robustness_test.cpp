#include <gtest/gtest.h>

#include <limits>

#include "kinequad/core/error.h"
#include "quad_checks.h"
#include "support/shapes.h"

namespace kinequad::test {
namespace {

std::vector<GridMap> valid_maps() {
    return {map_patches(torus(6, 5), 1, 5, 6, 7, 4).map, map_patches(square(4), 1, 4, 4, 3, 5).map,
            map_patches(cube(2), 6, 2, 2, 3, 3).map,
            map_patches(cylinder(5, 3), 1, 3, 5, 5, 3).map};
}

/// Whatever the map: a mesh that passes the checks, or an error of ours. Returns which.
bool extracts(const GridMap& map) {
    try {
        const QuadMesh mesh = extract_quads(map, Context{});
        require_valid(verify_quad_mesh(mesh, map.topology));
        return true;
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()), "");
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        return false;
    }
}

std::int64_t random_whole(std::mt19937& random, int cells) {
    return std::uniform_int_distribution<std::int64_t>(-cells, cells)(random) * GridMap::one;
}

TEST(ExtractRobustness, CornersPerturbed) {
    std::mt19937 random(1);
    for (const GridMap& valid : valid_maps()) {
        EXPECT_TRUE(extracts(valid));
        std::uniform_int_distribution<std::size_t> any(0, valid.corner.size() - 1);
        for (int round = 0; round < 300; ++round) {
            GridMap map = valid;
            auto& corner = map.corner[any(random)];
            corner.u += std::uniform_int_distribution<std::int64_t>(1, 4)(random)
                        << std::uniform_int_distribution<int>(0, 32)(random);
            EXPECT_FALSE(extracts(map));
        }
    }
}

TEST(ExtractRobustness, TransitionsPerturbed) {
    std::mt19937 random(2);
    for (const GridMap& valid : valid_maps()) {
        for (int h = 0; h < static_cast<int>(valid.corner.size()); ++h) {
            if (valid.topology.twin[static_cast<std::size_t>(h)] < 0) continue;
            GridMap map = valid;
            auto& transition = map.transition[static_cast<std::size_t>(h)];
            if (random() % 2 == 0) {
                transition.rotation += static_cast<int>(random() % 3) + 1;
            } else {
                transition.translation.u += random_whole(random, 3) + GridMap::one / 2;
            }
            EXPECT_FALSE(extracts(map));
        }
    }
}

TEST(ExtractRobustness, VerticesMovedUntilTrianglesFlip) {
    std::mt19937 random(3);
    int count = 0;
    for (const GridMap& valid : valid_maps()) {
        for (int round = 0; round < 300; ++round) {
            GridMap map = valid;
            const int moves = 1 + static_cast<int>(random() % 3);
            for (int i = 0; i < moves; ++i) {
                const int v =
                    static_cast<int>(random() % static_cast<unsigned>(map.topology.vertex_count));
                const int h = map.topology.vertex_half_edge[static_cast<std::size_t>(v)];
                auto z = map.corner[static_cast<std::size_t>(h)];
                const int fineness = static_cast<int>(random() % 3);
                z.u += random_whole(random, 3) >> fineness;
                z.v += random_whole(random, 3) >> fineness;
                grid_maps::spread(map, h, z);
            }
            const bool is_valid = verify_grid_map(map).valid();
            EXPECT_EQ(extracts(map), is_valid);
            count += is_valid ? 1 : 0;
        }
    }
    EXPECT_GT(count, 0);
}

TEST(ExtractRobustness, AllCoordinatesRandom) {
    std::mt19937 random(4);
    for (const GridMap& valid : valid_maps()) {
        for (int round = 0; round < 200; ++round) {
            GridMap map = valid;
            const int shift = static_cast<int>(random() % 63);
            for (auto& corner : map.corner) {
                corner.u = static_cast<std::int64_t>(random()) << 32 >> shift;
                corner.v = static_cast<std::int64_t>(random()) << 31 >> shift;
            }
            EXPECT_FALSE(extracts(map));
        }
    }
}

TEST(ExtractRobustness, SingleTriangles) {
    // One triangle has no transitions to break, so that the integer points and lines meet the
    // checks of the boundary alone.
    std::mt19937 random(9);
    Triangles F(1, 3);
    F << 0, 1, 2;
    CornerCoordinates uv(3, 2);
    for (int round = 0; round < 2000; ++round) {
        for (int i = 0; i < 6; ++i) uv.data()[i] = static_cast<double>(random() % 5) / 2;
        EXPECT_FALSE(extracts(make_grid_map(F, 3, uv)));
    }
}

TEST(ExtractRobustness, ExtremeNumbers) {
    constexpr auto largest = std::numeric_limits<std::int64_t>::max();
    constexpr auto smallest = std::numeric_limits<std::int64_t>::min();
    for (const GridMap& valid : valid_maps()) {
        for (const std::int64_t value :
             {largest, smallest, largest / 2, smallest / 2, std::int64_t{1} << 60}) {
            GridMap map = valid;
            map.corner[4].v = value;
            EXPECT_FALSE(extracts(map));
            map = valid;
            map.transition[static_cast<std::size_t>(map.topology.twin[1])].translation.u = value;
            EXPECT_FALSE(extracts(map));
            map = valid;
            map.transition[1].rotation = static_cast<int>(value);
            EXPECT_FALSE(extracts(map) &&
                         map.transition[1].rotation != valid.transition[1].rotation);
        }
    }
}

TEST(ExtractRobustness, TooManyCellsIsAnError) {
    const MappedShape shape = map_patches(square(1), 1, 1, 1, 1 << 20, 1 << 20);
    EXPECT_THROW(extract_quads(shape.map, Context{}), GridMapError);
}

TEST(ExtractRobustness, ArraysOfTheWrongSize) {
    const GridMap valid = valid_maps().front();
    GridMap map = valid;
    map.corner.pop_back();
    EXPECT_THROW(extract_quads(map, Context{}), GridMapError);
    map = valid;
    map.mesh.barycentric.conservativeResize(3, 3);
    EXPECT_THROW(extract_quads(map, Context{}), GridMapError);
    map = valid;
    map.mesh.F.row(0).swap(map.mesh.F.row(1));
    EXPECT_THROW(extract_quads(map, Context{}), GridMapError);
    map = valid;
    map.is_line.assign(map.corner.size(), 0);
    EXPECT_NO_THROW(extract_quads(map, Context{}));
    map.is_line.pop_back();
    EXPECT_THROW(extract_quads(map, Context{}), GridMapError);
    map.is_line.clear();
    EXPECT_NO_THROW(extract_quads(map, Context{})) << "there need be no lines";
}

TEST(ExtractRobustness, BadRefinementIsFoundByTheVerifier) {
    GridMap map = valid_maps().front();
    map.mesh.parent.assign(map.mesh.parent.size(), 1 << 30);
    EXPECT_FALSE(extracts(map));
    map = valid_maps().front();
    map.mesh.barycentric.setConstant(std::numeric_limits<double>::quiet_NaN());
    EXPECT_FALSE(extracts(map));
}

TEST(ExtractRobustness, SingularityOffTheGridIsNamed) {
    // A cube shifted by half a cell in every chart: transitions stay whole, corners do not.
    GridMap map = map_patches(cube(2), 6, 2, 2, 2, 2).map;
    EXPECT_TRUE(extracts(map));
    for (auto& corner : map.corner) {
        corner.u += GridMap::one / 2;
        corner.v += GridMap::one / 2;
    }
    for (std::size_t h = 0; h < map.corner.size(); ++h) {
        const auto turned =
            rotate({GridMap::one / 2, GridMap::one / 2}, map.transition[h].rotation);
        map.transition[h].translation.u += GridMap::one / 2 - turned.u;
        map.transition[h].translation.v += GridMap::one / 2 - turned.v;
    }
    EXPECT_GT(verify_grid_map(map).fractional_singularities, 0);
    try {
        extract_quads(map, Context{});
        FAIL();
    } catch (const GridMapError& error) {
        EXPECT_NE(std::string(error.what()).find("cone of 3 quarter turns"), std::string::npos);
    }
}

TEST(ExtractRobustness, Cancellation) {
    const std::atomic<bool> cancel = true;
    Context context;
    context.cancel = &cancel;
    EXPECT_THROW(extract_quads(valid_maps().front(), context), Cancelled);
}

}  // namespace
}  // namespace kinequad::test
