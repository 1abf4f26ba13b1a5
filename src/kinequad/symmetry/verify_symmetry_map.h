#pragma once

#include "kinequad/mesh/topology.h"
#include "kinequad/symmetry/symmetry_map.h"

namespace kinequad {

/// How far a map is from an involution: the distance of vertices `p` and `S(S(p))`, in percent of
/// the bounding-box diagonal.
struct InvolutionError {
    double mean_percent = 0;
    double max_percent = 0;
};

/// Measures the images (n) of the vertices of `mesh`, in whose positions distances are taken;
/// those with triangle -1 have none.
InvolutionError measure_involution(const TriangleMesh& mesh,
                                   const std::vector<SurfacePoint>& vertex_image);

/// Whether a map is worse than those that good landmarks give, which come back to within 0.2 % in
/// the mean and 2 % at most: some landmark may be wrong, or a limb has none.
inline bool is_doubtful(const InvolutionError& error) {
    return error.mean_percent > 0.5 || error.max_percent > 3;
}

/// What is true of a symmetry map, measured anew from the map alone.
struct SymmetryReport {
    double involution_mean_percent = 0;  ///< mean distance of vertices `p` and `S(S(p))`, in
                                         ///< percent of the bounding-box diagonal
    double involution_max_percent = 0;
    /// Mean distance of the points of the stationary curve from their images, in percent.
    double stationary_percent = 0;
    int stationary_loops = 0;  ///< closed polylines
    int stationary_paths = 0;  ///< polylines that end on the boundary
    bool is_complete = false;  ///< every image, angle and polyline is valid
    std::string problem;       ///< what is not valid, empty where complete
};

/// Measures a map of `mesh`, in whose positions distances are taken.
SymmetryReport verify_symmetry_map(const TriangleMesh& mesh, const SymmetryMap& map);

/// Position of the image of a surface point: the images of the corners of its triangle, weighted.
Vector3 image_position(const TriangleMesh& mesh, const std::vector<SurfacePoint>& vertex_image,
                       const SurfacePoint& point);

}  // namespace kinequad
