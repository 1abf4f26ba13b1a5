#pragma once

#include <string>
#include <vector>

#include "kinequad/core/context.h"
#include "kinequad/symmetry/anti_involution.h"
#include "kinequad/symmetry/closed_surface.h"
#include "kinequad/symmetry/surface_distances.h"

namespace kinequad {

/// A closed surface on the unit sphere, where its symmetry is the reflection in the plane
/// x . axis = 0.
struct SphereSymmetry {
    SpherePoints points;  ///< a row for every vertex of the closed surface
    RealVector3 axis;     ///< unit
    double fit_rms = 0;   ///< of the landmarks to the anti-involution, before the warp; chordal
};

/// Moves the conformal image `points` of `surface` so that `landmarks`, rows of it, become exactly
/// symmetric: fit, boost and warp, then the warp once more with the ends of limbs that the
/// landmarks miss. `distances` are those of at least the landmarks. Throws `InputError` (symmetry),
/// calling the landmarks `name`, where no reflection fits, or more than one.
SphereSymmetry find_sphere_symmetry(const ClosedSurface& surface, const SurfaceDistances& distances,
                                    const SpherePoints& points, const SphereLandmarks& landmarks,
                                    const std::string& name, const Context& context);

/// Images of points of the closed surface.
struct SphereImages {
    std::vector<SurfacePoint> points;  ///< on the closed surface
    int unplaced = 0;                  ///< found as nearest instead of containing triangle
};

/// Images of all vertices of the closed surface with triangles `topology`; triangle -1 for those
/// that belong to none.
SphereImages locate_vertex_images(const Topology& topology, const SphereSymmetry& symmetry,
                                  const Context& context);

/// Images of the centres of the surface's own triangles, where `vertices` are those of its
/// vertices.
SphereImages locate_centre_images(const ClosedSurface& surface, const SphereSymmetry& symmetry,
                                  const SphereImages& vertices, const Context& context);

/// The images of the vertices of the closed surface as points of the input's triangles: those on
/// cones fall to the boundary.
std::vector<SurfacePoint> images_on_input(const ClosedSurface& surface, const SphereImages& images);

}  // namespace kinequad
