#pragma once

#include <vector>

#include "kinequad/core/context.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {

/// Ties the vertices of a foreign mesh to the surface nearest to them, so that it can be carried
/// through an animation with `carried_positions`. `X` v x 3 positions in the pose of `V` (n x 3),
/// `F` m x 3. Returns the point of the surface nearest to every row of `X` (v). A vertex off the
/// surface is carried by its foot point: the offset is not kept. Throws `InputError` (mesh) where
/// the surface has no triangle or a position is not finite.
std::vector<SurfacePoint> bind_to_surface(const Positions& X, const Positions& V,
                                          const Triangles& F, const Context& context = {});

/// Positions (v x 3) of points tied to a surface in the frame whose vertex positions are `V` (n x
/// 3) with triangles `F` (m x 3).
Positions carried_positions(const std::vector<SurfacePoint>& points, const Positions& V,
                            const Triangles& F);

}  // namespace kinequad
