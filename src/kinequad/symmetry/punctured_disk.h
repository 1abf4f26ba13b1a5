#pragma once

#include "kinequad/core/context.h"
#include "kinequad/symmetry/flip_triangulation.h"
#include "kinequad/symmetry/sphere_points.h"

namespace kinequad {

/// A closed surface without one vertex and its triangles: a disk whose boundary is the vertex's
/// link. Vertices keep their numbers.
struct PuncturedDisk {
    FlipTriangulation mesh;
    int vertex_count = 0;
    int puncture = -1;
    std::vector<int> link;        ///< boundary vertices, with the disk on the left
    std::vector<double> spoke;    ///< unscaled lengths from the puncture to `link`
    std::vector<double> bearing;  ///< directions of the spokes at the puncture, over one full turn
};

/// Whether the triangles around `vertex` are well shaped, distinct and enclose it simply.
/// `half_edge` leaves the vertex.
bool has_good_star(const FlipTriangulation& mesh, int half_edge);

/// Removes the origin of `half_edge` and its triangles; `has_good_star` has to hold.
PuncturedDisk puncture_surface(const FlipTriangulation& mesh, int half_edge, int vertex_count);

/// Logarithmic scale factors (n) that make all inner vertices of the disk flat and send the
/// puncture to infinity, by Newton's method with Ptolemy flips of `disk.mesh`
/// [Gillespie 2021, Springborn 2020]; throws `Error` where it does not converge.
Eigen::VectorXd flatten_disk(PuncturedDisk& disk, const Context& context);

/// Plane positions (n x 2) of the disk: its link as boundary polygon, from the flat metric where
/// `u` was made by `flatten_disk` (`is_flat`), else from the star of the puncture turned inside
/// out; inner vertices by the harmonic map of the scaled metric.
Eigen::Matrix<Real, Eigen::Dynamic, 2> lay_out_disk(const PuncturedDisk& disk,
                                                    const Eigen::VectorXd& u, bool is_flat);

}  // namespace kinequad
