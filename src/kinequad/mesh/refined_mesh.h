#pragma once

#include <vector>

#include "kinequad/core/types.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {

/// A triangulation that refines an input mesh, or a part of one: every one of its triangles lies in
/// one input triangle.
struct RefinedMesh {
    Triangles F;              ///< m' x 3
    int vertex_count = 0;     ///< n'
    std::vector<int> parent;  ///< m': input triangle that holds a triangle
    Positions barycentric;    ///< 3m' x 3: row 3t+k, corner k of triangle t in its parent's
                              ///< barycentric coordinates (exact at input vertices)
};

/// The input itself, `F` (m x 3) over `vertex_count` vertices, as a refinement of itself.
RefinedMesh as_refined_mesh(const Triangles& F, int vertex_count);

/// The vertices of a refined mesh (n') as points of the input; triangle -1 where a vertex belongs
/// to no triangle.
std::vector<SurfacePoint> vertex_points(const RefinedMesh& mesh);

/// The half-edge of the input whose edge the half-edge `h` of a refined mesh lies on, -1 where it
/// lies inside an input triangle.
int side_of_parent(const RefinedMesh& mesh, int h);

/// A point of a refined mesh as a point of the input.
SurfacePoint point_of_input(const RefinedMesh& mesh, const SurfacePoint& point);

/// Finds points of the input in a refinement of the whole of it, which has to outlive this.
class RefinementSearch {
public:
    explicit RefinementSearch(const RefinedMesh& mesh);
    /// A point of the input as a point of the refined mesh: on a side or a corner of its triangle
    /// (barycentric coordinates exactly 0) where it lies there but for rounding.
    SurfacePoint find(const SurfacePoint& point) const;

private:
    const RefinedMesh& mesh_;
    std::vector<int> order_;  ///< triangles of the refined mesh, those of one parent together
    std::vector<int> start_;  ///< where those of a triangle of the input begin in `order_`
};

/// A refinement `inner` of the refined mesh `outer`, as a refinement of the input.
RefinedMesh as_refinement_of_input(const RefinedMesh& outer, const RefinedMesh& inner);

}  // namespace kinequad
