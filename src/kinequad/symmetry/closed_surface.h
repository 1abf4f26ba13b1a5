#pragma once

#include "kinequad/core/context.h"
#include "kinequad/mesh/intrinsic_metric.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {

/// A surface made closed: matching seams are welded, handles are cut, and
/// every hole is filled by a cone. Triangles keep their numbers and corners; those of the cones
/// follow.
struct ClosedSurface {
    Triangles F;                     ///< triangles over the welded vertices and the apexes
    Topology topology;               ///< of `F`
    IntrinsicMetric metric;          ///< over the edges of `topology`
    int triangle_count = 0;          ///< triangles of the input
    std::vector<int> vertex;         ///< n: welded vertex of a vertex of the input
    std::vector<int> cap_half_edge;  ///< a cone triangle: the input's half-edge at its base

    /// The point of the input's surface for a point of this one; from a cone it falls to the
    /// boundary.
    SurfacePoint to_input(const SurfacePoint& point) const;
};

/// Closes a surface. `mesh` holds the positions of a reference shape, which only decide what
/// coincides; `metric` is over the edges of `topology`. Throws `InputError` (symmetry) where the
/// closed surface is not connected or not of genus 0.
ClosedSurface close_surface(const TriangleMesh& mesh, const Topology& topology,
                            const IntrinsicMetric& metric, const Context& context);

}  // namespace kinequad
