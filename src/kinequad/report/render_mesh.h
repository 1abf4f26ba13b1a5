#pragma once

#include <string>
#include <vector>

#include "kinequad/core/context.h"
#include "kinequad/core/types.h"
#include "kinequad/report/camera.h"
#include "kinequad/report/image.h"

namespace kinequad {

/// A vertex to be shown as a dot.
struct RenderMarker {
    int vertex = 0;
    Color color = Color(0.85, 0.1, 0.1);
};

/// A polyline on or near the surface, shown where the surface does not hide it.
struct RenderCurve {
    Positions points;  ///< k x 3
    Color color = Color(0.1, 0.35, 0.85);
};

/// What is in a picture.
struct RenderScene {
    Positions V;               ///< n x 3
    Quads polygons;            ///< m x 4 vertex indices; the last is -1 for a triangle
    Positions polygon_colors;  ///< m x 3 colours in sRGB, or no rows: all alike
    std::vector<RenderMarker> markers;
    std::vector<RenderCurve> curves;
};

struct RenderOptions {
    int width = 1920;      ///< pixels
    int height = 1080;     ///< pixels
    double margin = 0.04;  ///< free border, as a fraction of the smaller side
    bool draw_edges = true;
    double edge_width = 1.1;   ///< pixels
    double marker_radius = 5;  ///< pixels
    double curve_width = 3;    ///< pixels
    Color surface_color = Color(0.91, 0.895, 0.87);
    Color edge_color = Color(0.10, 0.12, 0.17);
    Color background_top = Color(0.975, 0.98, 0.99);
    Color background_bottom = Color(0.90, 0.915, 0.935);
};

/// Polygons of a scene from triangles `F` (m x 3).
Quads polygons_of(const Triangles& F);

/// Dots for the irregular vertices of the quads `Q` (q x 4) over `vertex_count` vertices: red below
/// and blue above the valence of a regular one, which is four inside and three on the boundary
/// (where two, a convex corner, counts as regular too).
std::vector<RenderMarker> mark_irregular_vertices(const Quads& Q, int vertex_count);

/// Draws the scene: smoothly shaded, lit on both sides, edges of polygons (never the diagonals that
/// cut quads) as thin dark lines, hidden lines removed, with 16 samples a pixel, in software. Lines
/// fade where polygons are too small on the picture to be told apart. The picture does not depend
/// on the number of threads. Throws `InputError` (usage) for a picture without pixels or above 2^28
/// of them, (mesh) for an index out of range or a position that is not finite.
Image render_mesh(const RenderScene& scene, const Camera& camera, const RenderOptions& options,
                  const Context& context);

}  // namespace kinequad
