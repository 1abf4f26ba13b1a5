#pragma once

#include <string>
#include <vector>

#include "kinequad/core/types.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {

/// Direction of the stationary curve in a triangle that it crosses.
struct StationaryDirection {
    int triangle = -1;
    double angle = 0;  ///< radians in the triangle's frame; the curve is a line, so modulo pi
};

/// How good a symmetry map is. Distances are in percent of the bounding-box diagonal of the
/// reference shape.
struct SymmetryQuality {
    /// Root mean square of the landmarks' chordal distances on the unit sphere to where the fitted
    /// anti-involution sends their partners; 0 for a mirror plane.
    double fit_rms = 0;
    /// Mean difference between the two sides in the distances of landmarks from each other, in
    /// percent of the surface's extent; 0 for a mirror plane.
    double landmark_difference_percent = 0;
    double involution_mean_percent = 0;  ///< mean distance of vertices `p` and `S(S(p))`
    double involution_max_percent = 0;   ///< largest such distance
    int reversed_triangles = 0;          ///< triangles whose image keeps its orientation
    int unplaced_points = 0;             ///< images found as nearest instead of containing triangle
    double mirror_residual_percent = 0;  ///< rms distance to the mirrored shape; mirror plane only
};

/// The bilateral intrinsic symmetry `S` of a surface: an orientation-reversing map of the surface
/// to itself that is its own inverse. Made by `compute_symmetry_map` or `compute_mirror_map`, never
/// changed. docs/symmetry.md
struct SymmetryMap {
    std::vector<SurfacePoint> vertex_image;  ///< n: image of every vertex; triangle -1 where the
                                             ///< vertex belongs to no triangle
    std::vector<SurfacePoint> centre_image;  ///< m: image of the centroid of every triangle
    /// m: angle phi such that a direction `x` in the frame of triangle t becomes `phi[t] - x` in
    /// the frame of the triangle `centre_image[t].triangle`; radians.
    Eigen::VectorXd transport;
    /// n: signed height over the stationary curve, positive on one side and negative on the other,
    /// never 0, without unit; its zero set along the edges is the curve.
    Eigen::VectorXd height;
    /// The stationary curve as polylines with one point an edge crossed. A closed one repeats its
    /// first point at its end; others end on the boundary. Point k lies on the border of the
    /// triangles that segments k - 1 and k cross; its triangle is that of segment k.
    std::vector<std::vector<SurfacePoint>> stationary;
    /// Every triangle that the curve crosses, once, in the order of the polylines, with the curve's
    /// direction smoothed along it.
    std::vector<StationaryDirection> stationary_direction;
    std::string method;  ///< "conformal", "harmonic" or "mirror plane"
    SymmetryQuality quality;
};

}  // namespace kinequad
