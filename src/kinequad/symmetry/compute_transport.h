#pragma once

#include "kinequad/core/context.h"
#include "kinequad/mesh/intrinsic_metric.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {

/// What the images of vertices say about directions.
struct Transport {
    Eigen::VectorXd angle;       ///< m: `SymmetryMap::transport`
    int reversed_triangles = 0;  ///< triangles whose three images keep their orientation
};

/// The orientation-reversing rotation nearest to the differential of a map, for every triangle,
/// from the images of the vertices around it, unfolded beside the image of its centre.
/// `vertex_image` n and `centre_image` m points of the surface; `topology` may have further
/// triangles after those m, which fill holes.
Transport compute_transport(const Topology& topology, const IntrinsicMetric& metric,
                            const std::vector<SurfacePoint>& vertex_image,
                            const std::vector<SurfacePoint>& centre_image, const Context& context);

}  // namespace kinequad
