#include "kinequad/report/render_mesh.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/core/parallel.h"
#include "kinequad/report/rasterize.h"
#include "kinequad/report/shade.h"

namespace kinequad {
namespace {

using namespace report_detail;

int corner_count(const Quads& polygons, Eigen::Index polygon) {
    return polygons(polygon, 3) < 0 ? 3 : 4;
}

void check(const RenderScene& scene, const RenderOptions& options) {
    require(options.width > 0 && options.height > 0 &&
                static_cast<long long>(options.width) * options.height <= (1LL << 28),
            InputFault::usage, "a picture needs between 1 and 2^28 pixels");
    require(
        scene.polygon_colors.rows() == 0 || scene.polygon_colors.rows() == scene.polygons.rows(),
        InputFault::usage, "give one colour a polygon, or none");
    require(scene.V.allFinite(), InputFault::mesh, "a position to be drawn is not finite");
    const auto n = scene.V.rows();
    for (Eigen::Index p = 0; p < scene.polygons.rows(); ++p) {
        for (int k = 0; k < corner_count(scene.polygons, p); ++k) {
            const int vertex = scene.polygons(p, k);
            if (vertex < 0 || vertex >= n) {
                throw InputError(
                    InputFault::mesh,
                    fmt::format("polygon {} has vertex {}, of {} vertices", p, vertex, n));
            }
        }
    }
    for (const RenderMarker& marker : scene.markers) {
        require(marker.vertex >= 0 && marker.vertex < n, InputFault::mesh,
                "a marked vertex is out of range");
    }
    for (const RenderCurve& curve : scene.curves) {
        require(curve.points.allFinite(), InputFault::mesh, "a curve to be drawn is not finite");
    }
}

/// The scene in the frame of the picture, ready to be drawn.
struct Prepared {
    ScreenScene screen;
    Positions normals;  ///< n x 3, unit, in the frame of the picture
};

struct Projection {
    Eigen::Matrix3d frame;
    Vector3 center;
    double pixels_per_unit;
    double middle_x, middle_y;

    ScreenVertex operator()(const Vector3& point) const {
        const Vector3 p = pixels_per_unit * (frame.transpose() * (point - center));
        return {middle_x + p.x(), middle_y - p.y(), p.z()};
    }
};

Projection make_projection(const Camera& camera, const RenderOptions& options) {
    Projection projection;
    projection.frame << camera.right, camera.up, camera.toward;
    projection.center = camera.center;
    const double border = 2 * options.margin * std::min(options.width, options.height);
    projection.pixels_per_unit = std::min((options.width - border) / (2 * camera.half_width),
                                          (options.height - border) / (2 * camera.half_height));
    projection.middle_x = 0.5 * options.width;
    projection.middle_y = 0.5 * options.height;
    return projection;
}

/// Area-weighted vertex normals in the frame of the picture.
Positions vertex_normals(const RenderScene& scene, const Projection& projection) {
    const Positions seen = scene.V * projection.frame;
    Positions normals = Positions::Zero(scene.V.rows(), 3);
    for (Eigen::Index p = 0; p < scene.polygons.rows(); ++p) {
        const int corners = corner_count(scene.polygons, p);
        Vector3 normal = Vector3::Zero();
        const Vector3 origin = seen.row(scene.polygons(p, 0)).transpose();
        for (int k = 1; k + 1 < corners; ++k) {
            const Vector3 a = seen.row(scene.polygons(p, k)).transpose() - origin;
            const Vector3 b = seen.row(scene.polygons(p, k + 1)).transpose() - origin;
            normal += a.cross(b);
        }
        for (int k = 0; k < corners; ++k) normals.row(scene.polygons(p, k)) += normal.transpose();
    }
    for (Eigen::Index v = 0; v < normals.rows(); ++v) {
        const double length = normals.row(v).norm();
        if (length > 0) normals.row(v) /= length;
    }
    return normals;
}

double doubled_area(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// How visible the lines of a polygon are, from its size and the usual one in pixels beside the
/// width of a line: a mesh too fine for the picture is shown as a plain surface and not as a black
/// one.
double line_opacity(double area, double usual_area, double line_width) {
    const double size = std::sqrt(std::sqrt(area * usual_area));
    const double t = std::clamp((size / line_width - 1.5) / 4.5, 0.0, 1.0);
    return 0.9 * t * t * (3 - 2 * t);
}

void add_polygon(const RenderScene& scene, Eigen::Index p, ScreenScene& screen) {
    const auto corner = [&](int k) { return scene.polygons(p, k); };
    const auto on_screen = [&](int k) -> const ScreenVertex& {
        return screen.vertices[at(corner(k))];
    };
    struct Piece {
        std::array<int, 3> corners;
        std::array<bool, 3> is_edge;
    };
    std::vector<Piece> pieces;
    if (corner_count(scene.polygons, p) == 3) {
        pieces.push_back({{0, 1, 2}, {true, true, true}});
    } else {
        // The shorter diagonal in space, so that the split does not change with the viewpoint.
        const auto squared = [&](int i, int j) {
            return (scene.V.row(corner(i)) - scene.V.row(corner(j))).squaredNorm();
        };
        if (squared(0, 2) <= squared(1, 3)) {
            pieces.push_back({{0, 1, 2}, {true, true, false}});
            pieces.push_back({{0, 2, 3}, {false, true, true}});
        } else {
            pieces.push_back({{0, 1, 3}, {true, false, true}});
            pieces.push_back({{1, 2, 3}, {true, true, false}});
        }
    }
    for (const Piece& piece : pieces) {
        const auto [a, b, c] = piece.corners;
        const double twice = doubled_area(on_screen(a), on_screen(b), on_screen(c));
        if (!(std::abs(twice) > 1e-9)) continue;
        // With y down, a triangle that faces the viewer runs clockwise in pixels.
        ScreenTriangle triangle;
        triangle.polygon = static_cast<int>(p);
        triangle.seen_from_behind = twice > 0;
        if (twice > 0) {
            triangle.vertex = {corner(a), corner(b), corner(c)};
            triangle.is_edge = piece.is_edge;
        } else {
            triangle.vertex = {corner(a), corner(c), corner(b)};
            triangle.is_edge = {piece.is_edge[2], piece.is_edge[1], piece.is_edge[0]};
        }
        screen.triangles.push_back(triangle);
    }
}

/// Sets how visible lines are, once all triangles are known.
void fade_lines(const RenderOptions& options, std::size_t polygon_count, ScreenScene& screen) {
    std::vector<double> area(polygon_count, 0);
    for (const ScreenTriangle& triangle : screen.triangles) {
        const auto corner = [&](std::size_t k) -> const ScreenVertex& {
            return screen.vertices[at(triangle.vertex[k])];
        };
        area[at(triangle.polygon)] += 0.5 * std::abs(doubled_area(corner(0), corner(1), corner(2)));
    }
    double sum = 0;
    for (const double a : area) sum += a;
    const double usual = sum / static_cast<double>(std::max<std::size_t>(polygon_count, 1));
    for (ScreenTriangle& triangle : screen.triangles) {
        const double own = area[at(triangle.polygon)];
        triangle.line_opacity =
            options.draw_edges ? static_cast<float>(line_opacity(own, usual, options.edge_width))
                               : 0;
    }
}

Prepared prepare(const RenderScene& scene, const Camera& camera, const RenderOptions& options) {
    const Projection projection = make_projection(camera, options);
    Prepared prepared;
    prepared.normals = vertex_normals(scene, projection);
    ScreenScene& screen = prepared.screen;
    screen.width = options.width;
    screen.height = options.height;
    screen.half_line = 0.5 * options.edge_width;
    screen.vertices.reserve(static_cast<std::size_t>(scene.V.rows()));
    for (Eigen::Index v = 0; v < scene.V.rows(); ++v) {
        screen.vertices.push_back(projection(scene.V.row(v).transpose()));
    }
    screen.triangles.reserve(2 * static_cast<std::size_t>(scene.polygons.rows()));
    for (Eigen::Index p = 0; p < scene.polygons.rows(); ++p) {
        add_polygon(scene, p, screen);
    }
    fade_lines(options, static_cast<std::size_t>(scene.polygons.rows()), screen);
    for (const RenderCurve& curve : scene.curves) {
        for (Eigen::Index i = 0; i + 1 < curve.points.rows(); ++i) {
            screen.strokes.push_back({projection(curve.points.row(i).transpose()),
                                      projection(curve.points.row(i + 1).transpose()),
                                      0.5 * options.curve_width, 1.5 * options.curve_width,
                                      curve.color});
        }
    }
    for (const RenderMarker& marker : scene.markers) {
        // The bias would show dots of the far side through thin parts.
        if (prepared.normals(marker.vertex, 2) < -0.05) continue;
        const ScreenVertex& middle = screen.vertices[at(marker.vertex)];
        screen.strokes.push_back(
            {middle, middle, options.marker_radius, 2 * options.marker_radius, marker.color});
    }
    return prepared;
}

/// Colours the hits of the pixels of one tile, averaging in linear light.
class TilePainter {
public:
    TilePainter(const RenderScene& scene, const RenderOptions& options, const Prepared& prepared)
        : prepared_(prepared),
          surface_(linear_from_srgb(options.surface_color)),
          line_(linear_from_srgb(options.edge_color)) {
        for (int y = 0; y < options.height; ++y) {
            const double t = (y + 0.5) / options.height;
            background_.push_back(
                linear_from_srgb((1 - t) * options.background_top + t * options.background_bottom));
        }
        for (const ScreenStroke& stroke : prepared.screen.strokes) {
            strokes_.push_back(linear_from_srgb(stroke.color));
        }
        for (Eigen::Index p = 0; p < scene.polygon_colors.rows(); ++p) {
            polygons_.push_back(linear_from_srgb(scene.polygon_colors.row(p).transpose()));
        }
    }

    /// Linear light of a pixel of row `y` that shows nothing else.
    const Vector3& background(int y) const { return background_[at(y)]; }

    /// Linear light of the pixel at `x`, `y`.
    Vector3 pixel(const Hit* hits, int x, int y) const {
        Vector3 sum = Vector3::Zero();
        Vector3 face = Vector3::Zero();
        int face_index = -1;
        for (int s = 0; s < sample_count; ++s) {
            const Hit& hit = hits[s];
            switch (hit.kind) {
                case Hit::Kind::background:
                    sum += background(y);
                    break;
                case Hit::Kind::face:
                case Hit::Kind::line:
                    if (face_index != hit.index) face = face_color(hit.index, x + 0.5, y + 0.5);
                    face_index = hit.index;
                    sum += hit.kind == Hit::Kind::face ? face : on_line(hit.index, face);
                    break;
                case Hit::Kind::stroke:
                    sum += stroke_color(hit.index);
                    break;
                case Hit::Kind::stroke_rim:
                    sum += 0.25 * stroke_color(hit.index);
                    break;
            }
        }
        return sum / sample_count;
    }

private:
    const Vector3& stroke_color(int index) const { return strokes_[at(index)]; }

    Vector3 on_line(int index, const Vector3& face) const {
        const auto opacity =
            static_cast<double>(prepared_.screen.triangles[at(index)].line_opacity);
        return (1 - opacity) * face + opacity * line_;
    }

    Vector3 face_color(int index, double x, double y) const {
        const ScreenTriangle& triangle = prepared_.screen.triangles[at(index)];
        std::array<const ScreenVertex*, 3> corner{};
        for (std::size_t k = 0; k < 3; ++k) {
            corner[k] = &prepared_.screen.vertices[at(triangle.vertex[k])];
        }
        const ScreenVertex here{x, y, 0};
        Vector3 normal = Vector3::Zero();
        for (std::size_t k = 0; k < 3; ++k) {
            // The middle of the pixel may lie outside of a triangle that only some samples hit.
            const double weight =
                std::max(0.0, doubled_area(*corner[(k + 1) % 3], *corner[(k + 2) % 3], here));
            normal += weight * prepared_.normals.row(triangle.vertex[k]).transpose();
        }
        if (triangle.seen_from_behind) normal = -normal;
        const double length = normal.norm();
        normal = length > 0 ? Vector3(normal / length) : Vector3(Vector3::UnitZ());
        Vector3 albedo = polygons_.empty() ? surface_ : polygons_[at(triangle.polygon)];
        // The inside of an open surface is told from its outside by a warmer, darker tone.
        if (triangle.seen_from_behind) albedo = albedo.cwiseProduct(Vector3(0.62, 0.45, 0.36));
        return shade(albedo, normal);
    }

    const Prepared& prepared_;
    Vector3 surface_;
    Vector3 line_;
    std::vector<Vector3> background_;  ///< linear light, one a row of the picture
    std::vector<Vector3> strokes_;
    std::vector<Vector3> polygons_;  ///< empty where all have the colour of the surface
};

}  // namespace

Quads polygons_of(const Triangles& F) {
    Quads polygons(F.rows(), 4);
    polygons.leftCols<3>() = F;
    polygons.col(3).setConstant(-1);
    return polygons;
}

Image render_mesh(const RenderScene& scene, const Camera& camera, const RenderOptions& options,
                  const Context& context) {
    check(scene, options);
    const Prepared prepared = prepare(scene, camera, options);
    const TileLists tiles = sort_into_tiles(prepared.screen);
    const TilePainter painter(scene, options, prepared);
    Image image{options.width, options.height, {}};
    image.rgb.resize(image.offset(0, options.height));
    const auto paint = [&](int x, int y, const Vector3& light) {
        for (int c = 0; c < 3; ++c) {
            image.rgb[image.offset(x, y) + static_cast<std::size_t>(c)] =
                srgb_byte_from_linear(light[c]);
        }
    };
    const auto paint_tile = [&](std::size_t tile) {
        const int x0 = static_cast<int>(tile) % tiles.columns * tiles.size;
        const int y0 = static_cast<int>(tile) / tiles.columns * tiles.size;
        const bool is_empty = tiles.triangle_begin[tile] == tiles.triangle_begin[tile + 1] &&
                              tiles.stroke_begin[tile] == tiles.stroke_begin[tile + 1];
        const auto hits = is_empty ? std::vector<Hit>()
                                   : rasterize_tile(prepared.screen, tiles, static_cast<int>(tile));
        for (int y = y0; y < std::min(y0 + tiles.size, image.height); ++y) {
            auto hit = static_cast<std::size_t>(y - y0) * static_cast<std::size_t>(tiles.size) *
                       sample_count;
            for (int x = x0; x < std::min(x0 + tiles.size, image.width); ++x, hit += sample_count) {
                paint(x, y, is_empty ? painter.background(y) : painter.pixel(&hits[hit], x, y));
            }
        }
    };
    parallel_for(tiles.triangle_begin.size() - 1, 4, context,
                 [&](std::size_t begin, std::size_t end) {
                     for (std::size_t tile = begin; tile < end; ++tile) paint_tile(tile);
                 });
    return image;
}

}  // namespace kinequad
