#pragma once

#include <array>
#include <vector>

#include "kinequad/core/context.h"
#include "kinequad/synth/implicit_body.h"

namespace kinequad::synth_detail {

/// The half x >= 0 of a symmetric closed surface. Its boundary lies in the plane x = 0, no other
/// edge joins two vertices of the plane, and no other vertex is in it.
struct HalfMesh {
    std::vector<Vector3> vertices;
    std::vector<std::array<int, 3>> triangles;
    std::vector<char> in_plane;  ///< one a vertex
};

/// Meshes the half x >= 0 of `body` on a grid of cells of size `cell` (metres) shifted by `shift`
/// cells along y and z: one vertex a piece of surface in a cell, one pair of triangles a crossed
/// grid edge [Gibson 1998; Nielson 2004]. Only cells near the surface are visited.
HalfMesh mesh_half_body(const ImplicitBody& body, double cell, double shift,
                        const Context& context);

/// The same surface with shortest edges collapsed until the whole surface has at most
/// `triangle_count` triangles, keeping more of them where the body is thin.
HalfMesh decimate_half_mesh(const HalfMesh& mesh, const ImplicitBody& body, int triangle_count,
                            const Context& context);

/// The same surface with better triangles: edges flipped to Delaunay, vertices moved along the
/// surface towards their neighbours' mean, `rounds` times.
HalfMesh improve_half_mesh(const HalfMesh& mesh, const ImplicitBody& body, int rounds,
                           const Context& context);

}  // namespace kinequad::synth_detail
