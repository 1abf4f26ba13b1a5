#pragma once

#include <vector>

#include "kinequad/mesh/intrinsic_metric.h"
#include "kinequad/mesh/refined_mesh.h"

namespace kinequad {

/// A surface cut along the zero set of a height: every triangle lies above or below.
struct LevelSplit {
    RefinedMesh mesh;               ///< vertices of the input first, then those on cut edges
    std::vector<int> side;          ///< m': 1 above, -1 below
    std::vector<char> is_on_level;  ///< n': nonzero where the height is zero
};

/// The edge that says how far from the zero set a vertex is taken to lie on it.
enum class SnapUnit {
    crossed_edge,   ///< the one it is measured along: keeps the shapes of triangles
    shortest_edge,  ///< the shortest at the vertex: where triangles are long, keeps the zero set
};

/// Inserts the zero set of `height` (n, linear along edges, nowhere zero) into a triangulation.
///
/// Vertices within `snap_share` of the length of an edge from the zero set are taken to lie on it,
/// those first that are nearest by the edge that is crossed, where the zero set stays a curve that
/// neither branches nor touches itself; where it would, the curve keeps half that share away from
/// the vertex. So, with the crossed edge for a unit, no triangle gets much thinner than it was;
/// with the shortest one, long triangles may. A zero set that passes through vertices within
/// rounding errors, as on a mesh that is its own mirror image, passes through them exactly.
/// `snap_share` in [0, 0.5). docs/symmetry.md
LevelSplit split_along_level(const Topology& topology, const IntrinsicMetric& metric,
                             const Eigen::VectorXd& height, double snap_share,
                             SnapUnit unit = SnapUnit::crossed_edge);

}  // namespace kinequad
