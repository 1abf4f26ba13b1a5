#include "file_drawings.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/io/files.h"

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

Json read_json(const std::string& path) {
    try {
        return Json::parse(read_text_file(path));
    } catch (const Json::exception& error) {
        throw InputError(InputFault::file,
                         fmt::format("{}: is no JSON file of kinequad: {}", path, error.what()));
    }
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

Vector3 place_of(const Json& point, const Quads& polygons, const Positions& V) {
    const auto triangle = point.at(0).get<Eigen::Index>();
    Vector3 sum = Vector3::Zero();
    for (int k = 0; k < 3; ++k) {
        sum += point.at(at(k + 1)).get<double>() * V.row(polygons(triangle, k)).transpose();
    }
    return sum;
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
    const Json file = read_json(path);
    const bool fits = file.contains("mirror") && polygons.rows() % 2 == 0 &&
                      file["mirror"].size() == at(V.rows());
    require(fits, InputFault::mesh, path + ": does not belong to these quads");
    const Palette palette(V);
    const Eigen::Index half = polygons.rows() / 2;
    Positions colors(polygons.rows(), 3);
    for (Eigen::Index q = 0; q < half; ++q) {
        colors.row(q) = palette.at_place(centre_of(polygons, V, q)).transpose();
        colors.row(half + q) = colors.row(q);
    }
    return colors;
}

std::vector<RenderCurve> draw_streamlines(const std::string& path, const Quads& polygons,
                                          const Positions& V) {
    const Json file = read_json(path);
    require(file.contains("streamlines"), InputFault::mesh, path + ": holds no streamlines");
    std::vector<RenderCurve> curves;
    for (const Json& line : file["streamlines"]) {
        RenderCurve& curve = curves.emplace_back();
        curve.points.resize(static_cast<Eigen::Index>(line.size()), 3);
        for (std::size_t i = 0; i < line.size(); ++i) {
            require(line[i].at(0).get<Eigen::Index>() < polygons.rows(), InputFault::mesh,
                    path + ": does not belong to this surface");
            curve.points.row(static_cast<Eigen::Index>(i)) =
                place_of(line[i], polygons, V).transpose();
        }
    }
    return curves;
}

SymmetryDrawing draw_symmetry(const std::string& path, const Quads& polygons, const Positions& V) {
    const Json file = read_json(path);
    const bool fits = file.contains("image") && file.contains("stationary") &&
                      file["image"].size() == at(V.rows());
    require(fits, InputFault::mesh, path + ": does not belong to this surface");
    SymmetryDrawing drawing;
    std::vector<char> is_crossed(at(polygons.rows()), 0);
    for (const Json& line : file["stationary"]) {
        RenderCurve curve;
        curve.points.resize(static_cast<Eigen::Index>(line.size()), 3);
        for (std::size_t i = 0; i < line.size(); ++i) {
            curve.points.row(static_cast<Eigen::Index>(i)) =
                place_of(line[i], polygons, V).transpose();
            is_crossed[line[i].at(0).get<std::size_t>()] = 1;
        }
        drawing.curves.push_back(std::move(curve));
    }
    const std::vector<char> is_first = first_side(polygons, is_crossed);
    const Palette palette(V);
    drawing.colors.resize(polygons.rows(), 3);
    for (Eigen::Index t = 0; t < polygons.rows(); ++t) {
        Vector3 place = centre_of(polygons, V, t);
        if (!is_first[at(t)] && !is_crossed[at(t)]) {
            place.setZero();
            for (int k = 0; k < 3; ++k) {
                const Json& image = file["image"][at(polygons(t, k))];
                if (image.at(0).get<int>() >= 0) place += place_of(image, polygons, V) / 3;
            }
        }
        drawing.colors.row(t) = palette.at_place(place).transpose();
    }
    return drawing;
}

}  // namespace kinequad::app
