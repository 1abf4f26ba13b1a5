#include "kinequad/symmetry/sphere_symmetry.h"

#include <fmt/format.h>

#include <algorithm>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/core/parallel.h"
#include "kinequad/symmetry/locate_on_sphere.h"
#include "kinequad/symmetry/match_extremities.h"
#include "kinequad/symmetry/warp_to_landmarks.h"

namespace kinequad {
namespace {

/// Warps to the landmarks, then once more with the ends of limbs that these miss.
SpherePoints warp_and_extend(const ClosedSurface& surface, const SurfaceDistances& distances,
                             const SphereLandmarks& marks, const SpherePoints& points,
                             const RealVector3& axis, const Context& context) {
    SpherePoints warped = warp_to_landmarks(points, marks, axis, context);
    const SphereLandmarks more =
        match_extremities(surface.topology, surface.metric, distances, warped, axis);
    if (more.pairs.empty() && more.stationary.empty()) return warped;
    context.write_log(
        LogLevel::info,
        fmt::format("symmetry: {} pairs of limb ends and {} ends on the line of symmetry added to "
                    "the landmarks",
                    more.pairs.size(), more.stationary.size()));
    SphereLandmarks all = marks;
    all.pairs.insert(all.pairs.end(), more.pairs.begin(), more.pairs.end());
    all.stationary.insert(all.stationary.end(), more.stationary.begin(), more.stationary.end());
    return warp_to_landmarks(points, all, axis, context);
}

void require_fit(const AntiInvolution& fit, const std::string& name) {
    require(fit.definiteness > 1e-14, InputFault::symmetry,
            name +
                ": more than one symmetry fits these landmarks; add pairs far from each other, "
                "or points on the line of symmetry");
    require(fit.is_reflection, InputFault::symmetry,
            name +
                ": no reflection of the surface fits these landmarks; check that each pair "
                "joins left and right, and that stationary vertices lie on the line of "
                "symmetry");
}

}  // namespace

SphereSymmetry find_sphere_symmetry(const ClosedSurface& surface, const SurfaceDistances& distances,
                                    const SpherePoints& points, const SphereLandmarks& landmarks,
                                    const std::string& name, const Context& context) {
    const AntiInvolution fit = fit_anti_involution(points, landmarks);
    require_fit(fit, name);
    SphereSymmetry result{points, {}, fit.rms};
    result.axis = move_to_great_circle(result.points, fit);
    result.points =
        warp_and_extend(surface, distances, landmarks, result.points, result.axis, context);
    return result;
}

SphereImages locate_vertex_images(const Topology& topology, const SphereSymmetry& symmetry,
                                  const Context& context) {
    SphereImages images;
    images.points.assign(at(topology.vertex_count), SurfacePoint{});
    // In breadth-first order each search starts at the image of a neighbour.
    std::vector<int> queue;
    std::vector<int> hint(at(topology.vertex_count), -1);
    queue.push_back(topology.origin.front());
    hint[at(queue.front())] = 0;
    for (std::size_t i = 0; i < queue.size(); ++i) {
        if (i % 1024 == 0) context.check_cancelled();
        const int v = queue[i];
        const SphereLocation found = locate_on_sphere(
            topology, symmetry.points, mirrored(symmetry.points.row(v).transpose(), symmetry.axis),
            hint[at(v)]);
        images.points[at(v)] = found.point;
        if (!found.is_inside) ++images.unplaced;
        for (const int h : outgoing_half_edges(topology, v)) {
            int& next = hint[at(topology.target(h))];
            if (next >= 0) continue;
            next = found.point.triangle;
            queue.push_back(topology.target(h));
        }
    }
    return images;
}

SphereImages locate_centre_images(const ClosedSurface& surface, const SphereSymmetry& symmetry,
                                  const SphereImages& vertices, const Context& context) {
    const SpherePoints& points = symmetry.points;
    SphereImages images;
    images.points.resize(at(surface.triangle_count));
    std::vector<char> is_outside(images.points.size(), 0);
    parallel_for(images.points.size(), 512, context, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const auto row = static_cast<Eigen::Index>(t);
            const RealVector3 sum = (points.row(surface.F(row, 0)) + points.row(surface.F(row, 1)) +
                                     points.row(surface.F(row, 2)))
                                        .transpose();
            const int start = vertices.points[at(surface.F(row, 0))].triangle;
            const SphereLocation found = locate_on_sphere(
                surface.topology, points, mirrored(sum.normalized(), symmetry.axis), start);
            images.points[t] = surface.to_input(found.point);
            is_outside[t] = found.is_inside ? 0 : 1;
        }
    });
    images.unplaced = static_cast<int>(std::count(is_outside.begin(), is_outside.end(), 1));
    return images;
}

std::vector<SurfacePoint> images_on_input(const ClosedSurface& surface,
                                          const SphereImages& images) {
    std::vector<SurfacePoint> result = images.points;
    for (SurfacePoint& image : result) {
        if (image.triangle >= 0) image = surface.to_input(image);
    }
    return result;
}

}  // namespace kinequad
