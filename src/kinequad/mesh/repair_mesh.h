#pragma once

#include <string>
#include <vector>

#include "kinequad/core/types.h"

namespace kinequad {

/// What of a mesh is without extent, in all of its frames.
struct MeshDegeneracies {
    std::vector<char> is_flat;   ///< m: the triangle has no area in any frame
    std::vector<char> is_point;  ///< 3m: the half-edge has no length in any frame
    std::vector<double> length;  ///< 3m: summed over the frames
};

/// A mesh that was mended. Vertices keep their numbers: one that is not used any more stays, and
/// copies come after the last.
struct MeshRepair {
    Triangles F;                       ///< m' x 3
    std::vector<int> copied_vertices;  ///< sources of vertices n, n + 1, ...
    std::vector<std::string> actions;  ///< one line for everything that was done
};

/// Mends in `F` (m x 3, over `vertex_count` vertices) what can be mended without a change of the
/// surface or of what corresponds to what in the frames: triangles that name a vertex twice or
/// repeat another go, parts are oriented as most of their triangles, vertices whose triangles form
/// several fans are copied, vertices without triangles are passed over, edges without length are
/// contracted, triangles without area that are left are flipped away. What cannot be mended stays,
/// for `check_mesh` to name.
MeshRepair repair_mesh(const Triangles& F, int vertex_count, const MeshDegeneracies& degeneracies);

}  // namespace kinequad
