#pragma once

#include <memory>

#include "kinequad/core/types.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {

/// Where a surface is nearest to a point.
struct ClosestPoint {
    SurfacePoint point;           ///< on the surface searched
    double squared_distance = 0;  ///< in squared units of the input
};

/// Finds the points of a triangle mesh nearest to any points, exactly: the result is the minimum
/// over all triangles of `closest_point_on_triangle` in double precision, the lowest triangle where
/// several give the same. A bounding volume hierarchy in single precision (Embree) only says which
/// triangles cannot be the nearest, with a margin for its rounding, so that scale and distance from
/// the origin do not matter. Triangles may overlap, repeat, collapse and meet in any way.
class ClosestPoints {
public:
    /// `V` n x 3 finite positions, `F` m x 3 triangles, m at least 1. Throws `InputError` (mesh)
    /// where there is no triangle, a vertex index is out of range or a position is not finite.
    ClosestPoints(const Positions& V, const Triangles& F);
    ~ClosestPoints();
    ClosestPoints(ClosestPoints&&) noexcept;
    ClosestPoints& operator=(ClosestPoints&&) noexcept;

    /// Moves the surface to another frame: cheaper than building it anew while `F` has the same
    /// number of rows and the triangles stay about where they were among each other. Throws as the
    /// constructor.
    void update(const Positions& V, const Triangles& F);

    /// The nearest point of the surface. `hint` is a triangle that is probably near and speeds the
    /// search up, -1 for none; the result does not depend on it. Safe to call from several threads.
    ClosestPoint find(const Vector3& point, int hint = -1) const;

    /// The nearest point of the surface where that is farther than the root of `near`, else one
    /// that is not farther, which depends on `hint`: faster than `find` where most points are near.
    /// Safe to call from several threads.
    ClosestPoint find_unless_near(double near, const Vector3& point, int hint = -1) const;

    const Positions& positions() const;
    const Triangles& triangles() const;

private:
    struct Search;
    std::unique_ptr<Search> search_;
};

}  // namespace kinequad
