#include "kinequad/report/render_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kinequad/core/error.h"
#include "kinequad/report/draw_text.h"
#include "kinequad/report/render_panels.h"
#include "support/shapes.h"

namespace kinequad {
namespace {

Camera unit_camera() {
    Camera camera;
    camera.half_width = 1;
    camera.half_height = 1;
    return camera;
}

RenderOptions plain(int width, int height) {
    RenderOptions options;
    options.width = width;
    options.height = height;
    options.margin = 0;
    options.draw_edges = false;
    options.background_top = Color::Zero();
    options.background_bottom = Color::Zero();
    return options;
}

/// One rectangle in z = 0, the corners counter-clockwise seen from +z.
RenderScene rectangle(double low_x, double low_y, double high_x, double high_y) {
    RenderScene scene;
    scene.V.resize(4, 3);
    scene.V << low_x, low_y, 0, high_x, low_y, 0, high_x, high_y, 0, low_x, high_y, 0;
    scene.polygons.resize(1, 4);
    scene.polygons << 0, 1, 2, 3;
    return scene;
}

double brightness(const Image& image, int x, int y) {
    const std::size_t at = image.offset(x, y);
    return (image.rgb[at] + image.rgb[at + 1] + image.rgb[at + 2]) / 765.0;
}

template <class Test>
int count_pixels(const Image& image, const Test& test) {
    int count = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) count += test(image, x, y) ? 1 : 0;
    }
    return count;
}

bool is_red(const Image& image, int x, int y) {
    const std::size_t at = image.offset(x, y);
    return image.rgb[at] > 150 && image.rgb[at + 1] < 60 && image.rgb[at + 2] < 60;
}

bool is_blue(const Image& image, int x, int y) {
    const std::size_t at = image.offset(x, y);
    return image.rgb[at + 2] > 150 && image.rgb[at] < 60;
}

TEST(RenderMesh, HalfTheWidthCoversHalfThePixels) {
    const Image image =
        render_mesh(rectangle(-1, -1, 0, 1), unit_camera(), plain(200, 200), Context{});
    const int lit =
        count_pixels(image, [](const Image& i, int x, int y) { return brightness(i, x, y) > 0.1; });
    EXPECT_NEAR(lit, 20000, 200);
    EXPECT_GT(brightness(image, 50, 100), 0.1);
    EXPECT_EQ(brightness(image, 150, 100), 0);
}

TEST(RenderMesh, CoverageOfPartlyCoveredPixelsIsItsFraction) {
    // A side at 3/8 of a pixel; a surface facing the viewer has one colour everywhere.
    const double side = -1 + 2 * (100 + 0.375) / 200;
    const Image image =
        render_mesh(rectangle(-1, -1, side, 1), unit_camera(), plain(200, 200), Context{});
    const auto linear = [](double c) {
        return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    };
    const double full = linear(image.rgb[image.offset(50, 100)] / 255.0);
    const double part = linear(image.rgb[image.offset(100, 100)] / 255.0);
    EXPECT_NEAR(part / full, 0.375, 0.01);
}

TEST(RenderMesh, QuadIsCoveredWithoutACrackWhicheverWayItIsSplit) {
    for (const double skew : {-0.6, 0.0, 0.6}) {
        RenderScene scene = rectangle(-0.8, -0.8, 0.8, 0.8);
        scene.V(2, 0) += skew;
        const Image image = render_mesh(scene, unit_camera(), plain(173, 173), Context{});
        const int inner = count_pixels(image, [](const Image& i, int x, int y) {
            return x > 30 && x < 80 && y > 40 && y < 130 && brightness(i, x, y) < 0.1;
        });
        EXPECT_EQ(inner, 0) << skew;
    }
}

TEST(RenderMesh, DrawsEdgesOfPolygonsButNoDiagonals) {
    RenderOptions options = plain(200, 200);
    options.draw_edges = true;
    options.edge_width = 4;
    // Two rectangles side by side: three upright lines, of which the middle one is drawn by both.
    RenderScene scene;
    scene.V.resize(6, 3);
    scene.V << -0.9, -0.9, 0, 0, -0.9, 0, 0.9, -0.9, 0, -0.9, 0.9, 0, 0, 0.9, 0, 0.9, 0.9, 0;
    scene.polygons.resize(2, 4);
    scene.polygons << 0, 1, 4, 3, 1, 2, 5, 4;
    const Image image = render_mesh(scene, unit_camera(), options, Context{});
    const double face = brightness(image, 50, 80);
    int dark_runs = 0;
    int dark_pixels = 0;
    for (int x = 1; x < 200; ++x) {
        const auto is_line = [&](int at) {
            return at >= 10 && at < 190 && brightness(image, at, 80) < 0.6 * face;
        };
        dark_runs += is_line(x) && !is_line(x - 1) ? 1 : 0;
        dark_pixels += is_line(x) ? 1 : 0;
    }
    EXPECT_EQ(dark_runs, 3);
    EXPECT_EQ(dark_pixels, 8);

    RenderScene split = scene;
    split.polygons.resize(4, 4);
    split.polygons << 0, 1, 4, -1, 0, 4, 3, -1, 1, 2, 5, -1, 1, 5, 4, -1;
    const Image triangles = render_mesh(split, unit_camera(), options, Context{});
    int more_runs = 0;
    for (int x = 11; x < 190; ++x) {
        const auto is_line = [&](int at) { return brightness(triangles, at, 80) < 0.6 * face; };
        more_runs += is_line(x) && !is_line(x - 1) ? 1 : 0;
    }
    EXPECT_EQ(more_runs, 4);  // two diagonals and two upright lines after the first one
}

TEST(RenderMesh, NearerSurfaceHidesFartherOne) {
    RenderScene scene = rectangle(-1, -1, 1, 1);
    const RenderScene front = rectangle(-0.5, -0.5, 0.5, 0.5);
    scene.V.conservativeResize(8, 3);
    scene.V.bottomRows(4) = front.V;
    scene.V.bottomRows(4).col(2).setConstant(0.3);
    scene.polygons.resize(2, 4);
    scene.polygons << 4, 5, 6, 7, 0, 1, 2, 3;
    scene.polygon_colors.resize(2, 3);
    scene.polygon_colors << 1, 0, 0, 0, 0, 1;
    const Image image = render_mesh(scene, unit_camera(), plain(100, 100), Context{});
    EXPECT_GT(image.rgb[image.offset(50, 50)], 100);
    EXPECT_LT(image.rgb[image.offset(50, 50) + 2], 70);
    EXPECT_LT(image.rgb[image.offset(10, 50)], 70);
    EXPECT_GT(image.rgb[image.offset(10, 50) + 2], 100);
}

TEST(RenderMesh, DotsHaveTheirColorAndAreHiddenBehindTheSurface) {
    const TriangleMesh sphere = test::sphere(3);
    RenderScene scene{sphere.V, polygons_of(sphere.F), {}, {}, {}};
    Eigen::Index front = 0;
    Eigen::Index back = 0;
    sphere.V.col(2).maxCoeff(&front);
    sphere.V.col(2).minCoeff(&back);
    scene.markers = {{static_cast<int>(front), Color(1, 0, 0)},
                     {static_cast<int>(back), Color(0, 0, 1)}};
    RenderOptions options = plain(200, 200);
    options.marker_radius = 8;
    const Image image = render_mesh(scene, unit_camera(), options, Context{});
    // The dot's red inside ends 1.2 pixels before its rim; pixels that it covers by a third count.
    EXPECT_NEAR(count_pixels(image, is_red), 3.14159 * 7.1 * 7.1, 14);
    EXPECT_EQ(count_pixels(image, is_blue), 0);
    const Camera behind = fit_camera(sphere.V, named_viewpoint("back"));
    const Image other = render_mesh(scene, behind, options, Context{});
    EXPECT_EQ(count_pixels(other, is_red), 0);
    EXPECT_GT(count_pixels(other, is_blue), 100);
}

TEST(RenderMesh, CurvesShowInFrontAndHideBehind) {
    RenderScene scene = rectangle(-1, -1, 1, 1);
    RenderCurve curve{Positions(2, 3), Color(1, 0, 0)};
    curve.points << -0.8, 0.005, 0, 0.8, 0.005, 0;
    scene.curves = {curve};
    const RenderOptions options = plain(200, 200);
    const int shown = count_pixels(render_mesh(scene, unit_camera(), options, Context{}), is_red);
    EXPECT_NEAR(shown, 160 * options.curve_width, 20);
    scene.curves[0].points.col(2).setConstant(-0.5);
    EXPECT_EQ(count_pixels(render_mesh(scene, unit_camera(), options, Context{}), is_red), 0);
}

TEST(RenderMesh, SameBytesAtAnyNumberOfThreads) {
    const TriangleMesh torus = test::torus(40, 20);
    RenderScene scene{torus.V, polygons_of(torus.F), {}, {{0}, {7}}, {}};
    const Camera camera = fit_camera(torus.V, named_viewpoint("quarter"));
    RenderOptions options;
    options.width = 301;
    options.height = 203;
    Context context;
    context.threads = 1;
    const Image one = render_mesh(scene, camera, options, context);
    for (const int threads : {2, 8}) {
        context.threads = threads;
        EXPECT_EQ(render_mesh(scene, camera, options, context).rgb, one.rgb) << threads;
    }
}

TEST(RenderMesh, RefusesWhatItCannotDraw) {
    const RenderScene good = rectangle(-1, -1, 1, 1);
    EXPECT_THROW(render_mesh(good, unit_camera(), plain(0, 10), Context{}), InputError);
    RenderScene bad = good;
    bad.polygons(0, 1) = 4;
    EXPECT_THROW(render_mesh(bad, unit_camera(), plain(10, 10), Context{}), InputError);
    bad = good;
    bad.V(0, 0) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(render_mesh(bad, unit_camera(), plain(10, 10), Context{}), InputError);
}

TEST(MarkIrregularVertices, CubeCornersAreRedAndNothingElse) {
    // A cube of 2 x 2 x 2 quads a side has valence three at its eight corners alone; one side of
    // it, open, has no irregular vertex.
    Quads cube(6, 4);
    cube << 0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7;
    const auto markers = mark_irregular_vertices(cube, 8);
    ASSERT_EQ(markers.size(), 8U);
    for (const auto& marker : markers) EXPECT_GT(marker.color.x(), marker.color.z());
    Quads open(4, 4);
    open << 0, 1, 4, 3, 1, 2, 5, 4, 3, 4, 7, 6, 4, 5, 8, 7;
    EXPECT_TRUE(mark_irregular_vertices(open, 9).empty());
}

TEST(RenderPanels, EachPanelHasItsScene) {
    RenderScene left = rectangle(-1, -1, 1, 1);
    left.polygon_colors.resize(1, 3);
    left.polygon_colors << 1, 0, 0;
    RenderScene right = left;
    right.polygon_colors << 0, 0, 1;
    const Image image = render_panels({{left, unit_camera(), ""}, {right, unit_camera(), "B"}}, 2,
                                      plain(200, 100), Context{});
    EXPECT_GT(image.rgb[image.offset(50, 50)], image.rgb[image.offset(50, 50) + 2]);
    EXPECT_LT(image.rgb[image.offset(150, 50)], image.rgb[image.offset(150, 50) + 2]);
    EXPECT_THROW(render_panels({}, 2, plain(200, 100), Context{}), InputError);
}

TEST(DrawText, InkStaysInItsBox) {
    Image image{120, 40, std::vector<std::uint8_t>(120 * 40 * 3, 255)};
    const double width = text_width("Ab 4%", 14);
    ASSERT_LT(width, 80);
    const Image drawn = draw_text(image, "Ab 4%", 20, 30, 14, Color::Zero());
    const int ink =
        count_pixels(drawn, [](const Image& i, int x, int y) { return brightness(i, x, y) < 0.5; });
    EXPECT_GT(ink, 60);
    const int outside = count_pixels(drawn, [&](const Image& i, int x, int y) {
        return (x < 18 || x > 22 + width || y < 14 || y > 32) && brightness(i, x, y) < 1;
    });
    EXPECT_EQ(outside, 0);
}

}  // namespace
}  // namespace kinequad
