#include "kinequad/symmetry/format_symmetry_json.h"

#include <nlohmann/json.hpp>

namespace kinequad {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const SurfacePoint& point) {
    return {point.triangle, point.barycentric[0], point.barycentric[1], point.barycentric[2]};
}

}  // namespace

std::string format_symmetry_json(const SymmetryMap& map) {
    Json file;
    file["image"] = Json::array();
    for (const SurfacePoint& point : map.vertex_image) file["image"].push_back(to_json(point));
    file["stationary"] = Json::array();
    for (const auto& line : map.stationary) {
        Json points = Json::array();
        for (const SurfacePoint& point : line) points.push_back(to_json(point));
        file["stationary"].push_back(std::move(points));
    }
    file["method"] = map.method;
    const SymmetryQuality& q = map.quality;
    file["quality"] = {{"fit_rms", q.fit_rms},
                       {"landmark_difference_percent", q.landmark_difference_percent},
                       {"involution_mean_percent", q.involution_mean_percent},
                       {"involution_max_percent", q.involution_max_percent},
                       {"reversed_triangles", q.reversed_triangles},
                       {"unplaced_points", q.unplaced_points},
                       {"mirror_residual_percent", q.mirror_residual_percent}};
    return file.dump() + "\n";
}

}  // namespace kinequad
