#pragma once

#include <vector>

#include "kinequad/extract/quad_mesh.h"

namespace kinequad {

/// Joins a quad mesh of one side of a symmetric surface with its mirror image along the stationary
/// curve. `half` are the quads of the one side, `mirrored` the image of each of its vertices (v),
/// all of them points of the input; `is_on_curve` (v) tells which vertices both sides share.
/// Vertices of the given side come first, in their order. Sets `QuadMesh::mirror`.
/// docs/symmetry.md, "Quads that mirror exactly"
QuadMesh join_mirrored_quads(const QuadMesh& half, const std::vector<SurfacePoint>& mirrored,
                             const std::vector<char>& is_on_curve);

/// How well a quad mesh mirrors itself.
struct MirrorReport {
    int vertices = 0;
    int fixed_vertices = 0;   ///< vertices that are their own mirror vertices
    int broken_vertices = 0;  ///< vertices whose mirror vertex does not lead back to them
    int broken_quads = 0;     ///< quads whose mirrored corners, in reverse, are no quad
    /// Fixed vertices that do not have two edges, on the boundary one, to other fixed vertices
    /// along which the two sides meet.
    int loose_fixed_vertices = 0;

    bool valid() const {
        return broken_vertices == 0 && broken_quads == 0 && loose_fixed_vertices == 0;
    }
};

/// Checks that `quads.mirror` is an involution and an automorphism of the connectivity that
/// reverses orientation, and that its fixed vertices form chains of edges. Never throws.
MirrorReport verify_mirror(const QuadMesh& quads);

}  // namespace kinequad
