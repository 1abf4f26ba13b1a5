#pragma once

#include <vector>

#include "kinequad/core/context.h"
#include "kinequad/io/frame_source.h"
#include "kinequad/mesh/intrinsic_metric.h"
#include "kinequad/mesh/refined_mesh.h"
#include "kinequad/mesh/split_along_level.h"
#include "kinequad/symmetry/symmetry_map.h"

namespace kinequad {

/// One side of a symmetric surface, up to its stationary curve.
struct SymmetricHalf {
    RefinedMesh mesh;  ///< triangles on the positive side; the curve is boundary
    std::vector<SurfacePoint>
        mirrored;                   ///< n': images on the input; of a point of the curve itself
    std::vector<char> is_on_curve;  ///< n': nonzero on the stationary curve
};

/// The surface with the stationary curve of `map` inserted as edges. Vertices of the input next to
/// the curve, in terms of `unit`, come to lie on it (see `split_along_level`).
LevelSplit insert_stationary_curve(const Topology& topology, const IntrinsicMetric& metric,
                                   const SymmetryMap& map, SnapUnit unit = SnapUnit::crossed_edge);

/// Cuts the surface along the stationary curve of `map` and keeps the side of positive height, of
/// components that the curve does not meet the whole ones there. Images of boundary vertices lie on
/// the boundary: a loop goes to the one that its vertices are mapped next to in the shape `V` (n x
/// 3). Throws `InputError` (symmetry) where nothing lies on the positive side. docs/symmetry.md
SymmetricHalf take_symmetric_half(const Topology& topology, const IntrinsicMetric& metric,
                                  const SymmetryMap& map, const Positions& V, const Triangles& F);

/// Mirror images on the input of points of the half, given in its triangles: the points of the
/// surface nearest in all `frames` (each n x 3) together to where the mirrored corners of the
/// half's triangle put them. A point of the curve stays, a point of the boundary goes to the
/// boundary, evenly by length. `topology`, `metric` and `F` are those of the input.
std::vector<SurfacePoint> mirror_points(const SymmetricHalf& half, const Topology& topology,
                                        const IntrinsicMetric& metric, const Triangles& F,
                                        const std::vector<Positions>& frames,
                                        const std::vector<SurfacePoint>& points,
                                        const Context& context);

/// The point of the half, in its triangles, in the middle of `points`, as seen in `poses` of the
/// half (each n' x 3); with `is_on_boundary` the nearest one of the boundary. `topology` is that of
/// `half.mesh`.
SurfacePoint middle_point(const SymmetricHalf& half, const Topology& topology,
                          const std::vector<Positions>& poses,
                          const std::vector<SurfacePoint>& points, bool is_on_boundary);

/// Whether a point of the half, given in its triangles, lies on the stationary curve; `topology` is
/// that of `half.mesh`.
bool lies_on_curve(const SymmetricHalf& half, const Topology& topology, const SurfacePoint& point);

}  // namespace kinequad
