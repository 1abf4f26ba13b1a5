#include "kinequad/symmetry/match_extremities.h"

#include <algorithm>
#include <limits>

#include "kinequad/core/index.h"
#include "kinequad/mesh/edge_distances.h"
#include "kinequad/symmetry/locate_on_sphere.h"
#include "kinequad/symmetry/warp_to_landmarks.h"

namespace kinequad {
namespace {

// In shares of the surface's extent. An end that comes back nearer to itself is mapped as well as
// an end vertex can be chosen; matched from farther away, two limbs could be mistaken for each
// other.
constexpr double nearest_worth = 0.02;
constexpr double farthest_trusted = 0.15;

}  // namespace

SphereLandmarks match_extremities(const Topology& topology, const IntrinsicMetric& metric,
                                  const SurfaceDistances& distances, const SpherePoints& points,
                                  const RealVector3& axis) {
    const std::vector<int> ends = find_extremities(topology, distances);
    const std::size_t count = ends.size();
    SurfaceDistances from_ends;
    for (const int v : ends) {
        from_ends.source.push_back(v);
        from_ends.distance.push_back(edge_distances(topology, metric, {v}));
    }
    struct Choice {
        std::size_t end = 0;
        double return_distance = 0;  ///< of the end from its twice mapped self
        bool is_clear = false;
    };
    const auto image_of = [&](int v, int start) {
        const RealVector3 goal = mirrored(points.row(v).transpose(), axis);
        return locate_on_sphere(topology, points, goal, start).point;
    };
    std::vector<Choice> choice(count);
    for (std::size_t i = 0; i < count; ++i) {
        const SurfacePoint image = image_of(ends[i], 0);
        const int start = topology.vertex_half_edge[at(ends[i])] / 3;
        for (int k = 0; k < 3; ++k) {
            const int corner = topology.origin[3 * static_cast<std::size_t>(image.triangle) +
                                               static_cast<std::size_t>(k)];
            choice[i].return_distance +=
                image.barycentric[k] * from_ends.to_point(topology, i, image_of(corner, start));
        }
        double best = std::numeric_limits<double>::infinity();
        double second = best;
        for (std::size_t j = 0; j < count; ++j) {
            const double d = from_ends.to_point(topology, j, image);
            if (d < best) {
                second = best;
                best = d;
                choice[i].end = j;
            } else {
                second = std::min(second, d);
            }
        }
        choice[i].is_clear = best < farthest_trusted * distances.extent && 2 * best < second;
    }
    SphereLandmarks result;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t j = choice[i].end;
        const bool is_mutual = choice[i].is_clear && choice[j].is_clear && choice[j].end == i;
        const bool is_off = std::max(choice[i].return_distance, choice[j].return_distance) >
                            nearest_worth * distances.extent;
        if (!is_mutual || !is_off || j < i) continue;
        if (i == j) {
            result.stationary.push_back(ends[i]);
        } else {
            result.pairs.push_back({ends[i], ends[j]});
        }
    }
    return result;
}

}  // namespace kinequad
