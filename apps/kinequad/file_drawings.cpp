#include "file_drawings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/io/files.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad::app {
namespace {

using Json = nlohmann::json;

/// A colour that tells places apart: bands of hue from bottom to top, fields of light and dark.
Vector3 color_at(const Vector3& place, const Vector3& low, double size) {
    const Vector3 share = (place - low) / size;
    const double hue = 6 * (1.6 * share[1] - std::floor(1.6 * share[1]));
    const auto fields = static_cast<long>(std::floor(12 * share[0]) + std::floor(12 * share[2]) +
                                          std::floor(24 * share[1]));
    const double value = fields % 2 == 0 ? 0.95 : 0.72;
    const auto channel = [&](double shift) {
        const double x = std::fmod(shift + hue, 6.0);
        const double ramp = std::min({x, 4 - x, 1.0});
        return value * (1 - 0.55 * std::max(0.0, ramp));
    };
    return {channel(5), channel(3), channel(1)};
}

/// Hands the JSON at `path` to `draw` and returns what comes of it. Throws `InputError` (file)
/// where the file is not of the form that `draw` asks for.
template <class Draw>
auto draw_json(const std::string& path, const Draw& draw) {
    try {
        return draw(Json::parse(read_text_file(path)));
    } catch (const Json::exception& error) {
        throw InputError(InputFault::file,
                         fmt::format("{}: is no JSON file of kinequad: {}", path, error.what()));
    }
}

using List = Json::array_t;

/// `value` as a list; throws `Json::exception` where it is none.
const List& list_of(const Json& value) { return value.get_ref<const List&>(); }

/// `value` as an index below `count`, or -1 where it is no such index, as in a file of another
/// mesh. Throws `InputError` (file) where it is no whole number.
Eigen::Index index_of(const Json& value, Eigen::Index count, const std::string& path) {
    require(value.is_number_integer(), InputFault::file,
            path + ": has something else where an index belongs; write the file anew");
    const auto index = value.get<std::int64_t>();
    return index < count ? std::max<Eigen::Index>(index, -1) : -1;
}

/// The point [triangle, b0, b1, b2] of a surface of `triangles` triangles. Throws `InputError`
/// (file) where `value` is no such list, (mesh) where the surface has no such triangle.
SurfacePoint read_point(const Json& value, Eigen::Index triangles, const std::string& path) {
    // Writers leave rounding in coordinates that sum to one.
    constexpr double rounding = 1e-6;
    const List& numbers = list_of(value);
    require(numbers.size() == 4, InputFault::file,
            path + ": has a point that is not [triangle, b0, b1, b2]; write the file anew");
    const Eigen::Index triangle = index_of(numbers[0], triangles, path);
    require(triangle >= 0, InputFault::mesh, path + ": does not belong to this surface");
    SurfacePoint point{static_cast<int>(triangle), Vector3::Zero()};
    for (int k = 0; k < 3; ++k) point.barycentric[k] = numbers[at(k + 1)].get<double>();
    const bool is_inside = point.barycentric.minCoeff() >= -rounding &&
                           std::abs(point.barycentric.sum() - 1) <= rounding;
    require(is_inside, InputFault::file,
            path + ": has a point that lies in no triangle; write the file anew");
    return point;
}

Vector3 centre_of(const Quads& polygons, const Positions& V, Eigen::Index polygon) {
    const int corners = polygons(polygon, 3) < 0 ? 3 : 4;
    Vector3 sum = Vector3::Zero();
    for (int k = 0; k < corners; ++k) sum += V.row(polygons(polygon, k)).transpose() / corners;
    return sum;
}

/// Colours of all places in the box around `V`.
class Palette {
public:
    explicit Palette(const Positions& V)
        : low_(V.colwise().minCoeff().transpose()),
          size_((V.colwise().maxCoeff() - V.colwise().minCoeff()).maxCoeff()) {}
    Vector3 at_place(const Vector3& place) const { return color_at(place, low_, size_); }

private:
    Vector3 low_;
    double size_;
};

Vector3 place_of(const SurfacePoint& point, const Quads& polygons, const Positions& V) {
    Vector3 sum = Vector3::Zero();
    for (int k = 0; k < 3; ++k) {
        sum += point.barycentric[k] * V.row(polygons(point.triangle, k)).transpose();
    }
    return sum;
}

/// A polyline of points of the surface.
struct Line {
    RenderCurve curve;
    std::vector<int> triangles;  ///< of the points
};

Line read_line(const Json& value, const Quads& polygons, const Positions& V,
               const std::string& path) {
    const List& points = list_of(value);
    Line line;
    line.curve.points.resize(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const SurfacePoint point = read_point(points[i], polygons.rows(), path);
        line.curve.points.row(static_cast<Eigen::Index>(i)) =
            place_of(point, polygons, V).transpose();
        line.triangles.push_back(point.triangle);
    }
    return line;
}

/// Places of the images of the vertices; those without one are left out.
std::vector<std::optional<Vector3>> read_images(const Json& file, const Quads& polygons,
                                                const Positions& V, const std::string& path) {
    std::vector<std::optional<Vector3>> places;
    for (const Json& image : list_of(file.at("image"))) {
        std::optional<Vector3>& place = places.emplace_back();
        // To `==` the largest unsigned number is -1, too.
        const bool has_none =
            image.is_array() && !image.empty() && image[0] == -1 && !image[0].is_number_unsigned();
        if (!has_none) place = place_of(read_point(image, polygons.rows(), path), polygons, V);
    }
    return places;
}

/// On which side of the stationary curve the triangles are: those that can be reached from the
/// first without crossing a triangle of the curve, and the others.
std::vector<char> first_side(const Quads& polygons, const std::vector<char>& is_crossed) {
    std::map<std::pair<int, int>, Eigen::Index> owner;
    for (Eigen::Index t = 0; t < polygons.rows(); ++t) {
        for (int k = 0; k < 3; ++k) owner[{polygons(t, k), polygons(t, (k + 1) % 3)}] = t;
    }
    std::vector<char> is_first(at(polygons.rows()), 0);
    std::vector<Eigen::Index> stack;
    for (Eigen::Index t = 0; t < polygons.rows() && stack.empty(); ++t) {
        if (!is_crossed[at(t)]) stack.push_back(t);
    }
    while (!stack.empty()) {
        const Eigen::Index t = stack.back();
        stack.pop_back();
        if (is_first[at(t)] || is_crossed[at(t)]) continue;
        is_first[at(t)] = 1;
        for (int k = 0; k < 3; ++k) {
            const auto across = owner.find({polygons(t, (k + 1) % 3), polygons(t, k)});
            if (across != owner.end()) stack.push_back(across->second);
        }
    }
    return is_first;
}

}  // namespace

Positions color_mirrored_quads(const std::string& path, const Quads& polygons, const Positions& V) {
    return draw_json(path, [&](const Json& file) {
        const bool fits = file.contains("mirror") && polygons.rows() % 2 == 0 &&
                          list_of(file["mirror"]).size() == at(V.rows());
        require(fits, InputFault::mesh, path + ": does not belong to these quads");
        for (const Json& mirror : list_of(file["mirror"])) {
            require(index_of(mirror, V.rows(), path) >= 0, InputFault::mesh,
                    path + ": names a vertex that these quads do not have");
        }
        const Palette palette(V);
        const Eigen::Index half = polygons.rows() / 2;
        Positions colors(polygons.rows(), 3);
        for (Eigen::Index q = 0; q < half; ++q) {
            colors.row(q) = palette.at_place(centre_of(polygons, V, q)).transpose();
            colors.row(half + q) = colors.row(q);
        }
        return colors;
    });
}

std::vector<RenderCurve> draw_streamlines(const std::string& path, const Quads& polygons,
                                          const Positions& V) {
    return draw_json(path, [&](const Json& file) {
        require(file.contains("streamlines"), InputFault::mesh, path + ": holds no streamlines");
        std::vector<RenderCurve> curves;
        for (const Json& line : list_of(file["streamlines"])) {
            curves.push_back(read_line(line, polygons, V, path).curve);
        }
        return curves;
    });
}

SymmetryDrawing draw_symmetry(const std::string& path, const Quads& polygons, const Positions& V) {
    return draw_json(path, [&](const Json& file) {
        const bool fits = file.contains("image") && file.contains("stationary") &&
                          list_of(file["image"]).size() == at(V.rows());
        require(fits, InputFault::mesh, path + ": does not belong to this surface");
        SymmetryDrawing drawing;
        std::vector<char> is_crossed(at(polygons.rows()), 0);
        for (const Json& value : list_of(file["stationary"])) {
            Line line = read_line(value, polygons, V, path);
            for (const int t : line.triangles) is_crossed[at(t)] = 1;
            drawing.curves.push_back(std::move(line.curve));
        }
        const std::vector<std::optional<Vector3>> images = read_images(file, polygons, V, path);
        const std::vector<char> is_first = first_side(polygons, is_crossed);
        const Palette palette(V);
        drawing.colors.resize(polygons.rows(), 3);
        for (Eigen::Index t = 0; t < polygons.rows(); ++t) {
            Vector3 place = centre_of(polygons, V, t);
            if (!is_first[at(t)] && !is_crossed[at(t)]) {
                place.setZero();
                for (int k = 0; k < 3; ++k) {
                    const std::optional<Vector3>& image = images[at(polygons(t, k))];
                    if (image) place += *image / 3;
                }
            }
            drawing.colors.row(t) = palette.at_place(place).transpose();
        }
        return drawing;
    });
}

}  // namespace kinequad::app
