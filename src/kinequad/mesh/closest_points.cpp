#include "kinequad/mesh/closest_points.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "kinequad/core/error.h"
#include "kinequad/core/parallel.h"
#include "kinequad/mesh/closest_point_on_triangle.h"

namespace kinequad {
namespace {

// The hierarchy lives in a box of half-width 1, where single precision rounds a coordinate by at
// most 6e-8 and a distance by a few times that: ten times as much is the margin, absolute and
// relative.
constexpr double margin = 2e-6;
// Beyond this many box widths single precision says nothing any more about which triangle is
// nearer.
constexpr double farthest = 1e4;

float round_down(double x) {
    return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity());
}
float round_up(double x) {
    return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
}

void check_surface(const Positions& V, const Triangles& F) {
    require(F.rows() > 0, InputFault::mesh,
            "the surface has no triangle to measure a distance to; give one with faces");
    require(V.allFinite(), InputFault::mesh,
            "the surface has a position that is not finite; mend the vertex list");
    if (F.minCoeff() < 0 || F.maxCoeff() >= V.rows()) {
        throw InputError(
            InputFault::mesh,
            fmt::format("the triangles name vertices {} to {}, but there are {}; mend the "
                        "face list",
                        F.minCoeff(), F.maxCoeff(), V.rows()));
    }
}

}  // namespace

struct ClosestPoints::Search {
    Positions V;
    Triangles F;
    Vector3 center = Vector3::Zero();
    double scale = 1;
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    RTCGeometry geometry = nullptr;

    Search() = default;
    Search(const Search&) = delete;
    Search& operator=(const Search&) = delete;
    ~Search() {
        if (geometry != nullptr) rtcReleaseGeometry(geometry);
        if (scene != nullptr) rtcReleaseScene(scene);
        if (device != nullptr) rtcReleaseDevice(device);
    }

    Vector3 corner(int t, int k) const { return V.row(F(t, k)).transpose(); }
    TrianglePoint closest_on(const Vector3& p, int t) const {
        return closest_point_on_triangle(p, corner(t, 0), corner(t, 1), corner(t, 2));
    }

    void place(const Positions& positions, const Triangles& triangles) {
        V = positions;
        F = triangles;
        const Vector3 low = V.colwise().minCoeff().transpose();
        const Vector3 high = V.colwise().maxCoeff().transpose();
        center = 0.5 * low + 0.5 * high;
        const double half_width = (0.5 * high - 0.5 * low).maxCoeff();
        scale = half_width > 0 ? 1 / half_width : 1;
        if (!std::isfinite(scale)) scale = 1;
    }

    void commit() {
        rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(F.rows()));
        rtcCommitGeometry(geometry);
        // Callers that have several hierarchies build them in parallel.
        run_on_one_thread([this] { rtcCommitScene(scene); });
        if (rtcGetDeviceError(device) != RTC_ERROR_NONE) {
            throw std::runtime_error("Embree could not build its hierarchy");
        }
    }

    void build() {
        // A number of threads given here would bind all tasks of the program while the device is
        // alive, not only Embree's.
        device = rtcNewDevice(nullptr);
        if (device == nullptr) throw std::runtime_error("Embree cannot be started");
        scene = rtcNewScene(device);
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_DYNAMIC);
        geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserData(geometry, this);
        rtcSetGeometryBoundsFunction(geometry, bound_triangle, nullptr);
        rtcSetGeometryPointQueryFunction(geometry, visit_triangle);
        rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_REFIT);
        rtcAttachGeometry(scene, geometry);
        commit();
    }

    static void bound_triangle(const RTCBoundsFunctionArguments* arguments) {
        const auto& self = *static_cast<const Search*>(arguments->geometryUserPtr);
        const int t = static_cast<int>(arguments->primID);
        const Vector3 a = self.corner(t, 0);
        const Vector3 b = self.corner(t, 1);
        const Vector3 c = self.corner(t, 2);
        const Vector3 low = (a.cwiseMin(b).cwiseMin(c) - self.center) * self.scale;
        const Vector3 high = (a.cwiseMax(b).cwiseMax(c) - self.center) * self.scale;
        *arguments->bounds_o = {round_down(low[0]), round_down(low[1]), round_down(low[2]), 0,
                                round_up(high[0]),  round_up(high[1]),  round_up(high[2]),  0};
    }

    /// One query under way: the best so far, and the radius that still has to be searched.
    struct Query {
        const Search* search;
        Vector3 point;
        double slack;  ///< what rounding may add to a distance, in the box of half-width 1
        ClosestPoint best;
        double enough = -1;  ///< squared distance at which nothing better is looked for

        bool is_done() const { return best.point.triangle >= 0 && best.squared_distance <= enough; }
        float radius() const {
            const double scaled = std::sqrt(best.squared_distance) * search->scale;
            return round_up(scaled * (1 + margin) + slack);
        }
        bool improve(int t) {
            const TrianglePoint found = search->closest_on(point, t);
            const bool is_tie = found.squared_distance == best.squared_distance;
            if (best.point.triangle >= 0 && !(found.squared_distance < best.squared_distance) &&
                !(is_tie && t < best.point.triangle)) {
                return false;
            }
            best = {{t, found.barycentric}, found.squared_distance};
            return !is_tie;
        }
    };

    static bool visit_triangle(RTCPointQueryFunctionArguments* arguments) {
        Query& query = *static_cast<Query*>(arguments->userPtr);
        if (!query.improve(static_cast<int>(arguments->primID))) return false;
        const float radius = query.is_done() ? 0 : query.radius();
        if (radius >= arguments->query->radius) return false;
        arguments->query->radius = radius;
        return true;
    }

    /// The nearest point, or one that is not farther than the root of `enough`.
    ClosestPoint nearest(const Vector3& point, int hint, double enough) const {
        const Vector3 scaled = (point - center) * scale;
        const double reach = scaled.cwiseAbs().maxCoeff();
        Query query{this, point, margin * (1 + reach), {}, enough};
        if (hint >= 0 && hint < F.rows()) query.improve(hint);
        if (query.is_done()) return query.best;
        if (!(reach < farthest)) {
            for (int t = 0; t < F.rows(); ++t) query.improve(t);
            return query.best;
        }
        RTCPointQuery sphere;
        sphere.x = static_cast<float>(scaled[0]);
        sphere.y = static_cast<float>(scaled[1]);
        sphere.z = static_cast<float>(scaled[2]);
        sphere.time = 0;
        sphere.radius = query.best.point.triangle >= 0 ? query.radius()
                                                       : std::numeric_limits<float>::infinity();
        RTCPointQueryContext context;
        rtcInitPointQueryContext(&context);
        rtcPointQuery(scene, &sphere, &context, nullptr, &query);
        return query.best;
    }
};

ClosestPoints::ClosestPoints(const Positions& V, const Triangles& F) {
    check_surface(V, F);
    search_ = std::make_unique<Search>();
    search_->place(V, F);
    search_->build();
}

ClosestPoints::~ClosestPoints() = default;
ClosestPoints::ClosestPoints(ClosestPoints&&) noexcept = default;
ClosestPoints& ClosestPoints::operator=(ClosestPoints&&) noexcept = default;

void ClosestPoints::update(const Positions& V, const Triangles& F) {
    check_surface(V, F);
    search_->place(V, F);
    search_->commit();
}

ClosestPoint ClosestPoints::find(const Vector3& point, int hint) const {
    return search_->nearest(point, hint, -1);
}

ClosestPoint ClosestPoints::find_unless_near(double near, const Vector3& point, int hint) const {
    return search_->nearest(point, hint, near);
}

const Positions& ClosestPoints::positions() const { return search_->V; }
const Triangles& ClosestPoints::triangles() const { return search_->F; }

}  // namespace kinequad
