#pragma once

#include <string>
#include <vector>

#include "kinequad/core/types.h"
#include "kinequad/report/render_mesh.h"

namespace kinequad::app {

/// Colours for quads and the permutation of a mirror.json at `path`: the first half of the quads is
/// coloured by where it is in the pose `V` (n x 3), every mirrored quad as its partner. Returns m x
/// 3 colours in sRGB. Throws `InputError` (file) where the file is no such JSON, (mesh) where it
/// does not fit the quads `polygons` (m x 4).
Positions color_mirrored_quads(const std::string& path, const Quads& polygons, const Positions& V);

/// What a symmetry.json at `path` says of a surface of triangles `polygons` (m x 4, the last index
/// -1) in the pose `V`: one side is coloured by where it is, the other by where its image is, so
/// that left and right look alike where the map is right; and the stationary curve. Throws
/// `InputError` (file) where the file is no such JSON, (mesh) where it belongs to another surface.
struct SymmetryDrawing {
    Positions colors;  ///< m x 3, sRGB
    std::vector<RenderCurve> curves;
};
SymmetryDrawing draw_symmetry(const std::string& path, const Quads& polygons, const Positions& V);

/// The streamlines of a field.json at `path`, as `run --dump-stages` writes it, on a surface of
/// triangles `polygons` (m x 4, the last index -1) in the pose `V` (n x 3). Throws as
/// `draw_symmetry`.
std::vector<RenderCurve> draw_streamlines(const std::string& path, const Quads& polygons,
                                          const Positions& V);

}  // namespace kinequad::app
