#pragma once

#include <vector>

#include "kinequad/mesh/intrinsic_metric.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {

/// Walks along lines of mesh edges: on the boundary, a line of symmetry, features. `topology` and
/// `metric` have to outlive this.
class LineWalk {
public:
    /// `edges` are the edges of the lines. A walk passes a vertex where two of them meet and go on
    /// within 50 degrees of straight; elsewhere it ends.
    LineWalk(const Topology& topology, const IntrinsicMetric& metric,
             const std::vector<int>& edges);

    /// The edge of a line that a point lies on, by its barycentric coordinates; -1 off the lines.
    int edge_of(const SurfacePoint& point) const;
    /// Whether a walk may begin at a point: it lies on a line, but at none of its ends.
    bool is_passed(const SurfacePoint& point) const;
    /// The same point, for a walk to begin at: a vertex of a line is named by a triangle with an
    /// edge of the line there, whichever of its triangles named it. All others come back as given.
    SurfacePoint seat(const SurfacePoint& point) const;
    /// The point reached by walking along the line from `start`, which lies on it, as far as
    /// `move`, a vector in the frame of its triangle, goes along it. The walk ends after passing
    /// 1000 vertices. `start` comes back where its triangle has no edge of the line, see `seat`.
    SurfacePoint walk(const SurfacePoint& start, const Vector2& move) const;

private:
    bool is_straight_at(int v) const;
    int half_edge_at(const SurfacePoint& point) const;

    const Topology& topology_;
    const IntrinsicMetric& metric_;
    std::vector<char> is_line_;               ///< e
    std::vector<std::vector<int>> lines_at_;  ///< n: edges of lines at a vertex
    std::vector<char> is_passed_;             ///< n
};

}  // namespace kinequad
