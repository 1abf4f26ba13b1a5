#pragma once

#include "kinequad/mesh/topology.h"
#include "kinequad/mesh/triangle_mesh.h"
#include "kinequad/symmetry/sphere_points.h"

namespace kinequad {

/// Where a direction meets a spherical triangulation.
struct SphereLocation {
    SurfacePoint point;
    bool is_inside = true;  ///< false where no triangle holds it and a near one was taken
};

/// Finds the spherical triangle that holds a point, by walking from triangle `start` towards it;
/// where reversed triangles lead the walk astray all triangles are asked. `points` has a row for
/// every vertex of the closed `topology`.
SphereLocation locate_on_sphere(const Topology& topology, const SpherePoints& points,
                                const RealVector3& query, int start);

}  // namespace kinequad
