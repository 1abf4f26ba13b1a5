#include "kinequad/symmetry/locate_on_sphere.h"

#include <algorithm>
#include <limits>

#include "kinequad/core/index.h"
#include "kinequad/mesh/closest_point_on_triangle.h"

namespace kinequad {
namespace {

struct Corners {
    RealVector3 a, b, c;
};

Corners corners_of(const Topology& topology, const SpherePoints& points, int t) {
    return {points.row(topology.origin[at(3 * t)]).transpose(),
            points.row(topology.origin[at(3 * t + 1)]).transpose(),
            points.row(topology.origin[at(3 * t + 2)]).transpose()};
}

/// Unnormalised barycentric coordinates of the ray through `q`: of corner k on the side opposite.
RealVector3 ray_coordinates(const Corners& k, const RealVector3& q) {
    return {arc_side(k.b, k.c, q), arc_side(k.c, k.a, q), arc_side(k.a, k.b, q)};
}

SurfacePoint point_of(int t, const RealVector3& coordinates) {
    const RealVector3 clamped = coordinates.cwiseMax(Real(0));
    const Vector3 barycentric = (clamped / clamped.sum()).cast<double>();
    return {t, barycentric / barycentric.sum()};
}

/// Exhaustive: a triangle that holds the query, of any orientation, else the nearest one.
SphereLocation search_all(const Topology& topology, const SpherePoints& points,
                          const RealVector3& query) {
    SphereLocation best;
    best.is_inside = false;
    double nearest = std::numeric_limits<double>::infinity();
    for (int t = 0; t < topology.triangle_count; ++t) {
        const Corners k = corners_of(topology, points, t);
        RealVector3 x = ray_coordinates(k, query);
        const bool faces = (k.a + k.b + k.c).dot(query) > 0;
        const Real sum = x.sum();
        if (faces && sum < 0) x = -x;
        if (faces && sum != 0 && x.minCoeff() >= 0) return {point_of(t, x), sum > 0};
        // Distances from the query, not positions, keep tiny triangles apart.
        const TrianglePoint found =
            closest_point_on_triangle(Vector3::Zero(), (k.a - query).cast<double>(),
                                      (k.b - query).cast<double>(), (k.c - query).cast<double>());
        if (found.squared_distance < nearest) {
            nearest = found.squared_distance;
            best.point = {t, found.barycentric};
        }
    }
    return best;
}

}  // namespace

SphereLocation locate_on_sphere(const Topology& topology, const SpherePoints& points,
                                const RealVector3& query, int start) {
    int t = start;
    int previous = -1;
    const int longest = 100 + 4 * static_cast<int>(std::max(1, topology.triangle_count / 100));
    for (int step = 0; step < longest; ++step) {
        const Corners k = corners_of(topology, points, t);
        const RealVector3 x = ray_coordinates(k, query);
        if (x.minCoeff() >= 0 && x.sum() > 0) return {point_of(t, x), true};
        // Out through the side that the query lies farthest beyond, but never straight back.
        int exit = -1;
        Real lowest = 0;
        for (int corner = 0; corner < 3; ++corner) {
            const int across = topology.twin[at(3 * t + (corner + 1) % 3)];
            if (across < 0 || across / 3 == previous) continue;
            if (x[corner] < lowest) {
                lowest = x[corner];
                exit = across;
            }
        }
        if (exit < 0) break;
        previous = t;
        t = exit / 3;
    }
    return search_all(topology, points, query);
}

}  // namespace kinequad
