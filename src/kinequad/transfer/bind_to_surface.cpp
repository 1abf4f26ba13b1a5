#include "kinequad/transfer/bind_to_surface.h"

#include "kinequad/core/error.h"
#include "kinequad/core/parallel.h"
#include "kinequad/mesh/closest_points.h"

namespace kinequad {

std::vector<SurfacePoint> bind_to_surface(const Positions& X, const Positions& V,
                                          const Triangles& F, const Context& context) {
    require(X.allFinite(), InputFault::mesh,
            "the mesh to bind has a position that is not finite; mend its vertex list");
    const ClosestPoints surface(V, F);
    std::vector<SurfacePoint> result(static_cast<std::size_t>(X.rows()));
    parallel_for(result.size(), 256, context, [&](std::size_t begin, std::size_t end) {
        int hint = -1;
        for (std::size_t i = begin; i < end; ++i) {
            result[i] = surface.find(X.row(static_cast<Eigen::Index>(i)).transpose(), hint).point;
            hint = result[i].triangle;
        }
    });
    return result;
}

Positions carried_positions(const std::vector<SurfacePoint>& points, const Positions& V,
                            const Triangles& F) {
    Positions result(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i) {
        result.row(static_cast<Eigen::Index>(i)) = position_of(points[i], V, F).transpose();
    }
    return result;
}

}  // namespace kinequad
