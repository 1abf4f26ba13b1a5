#pragma once

#include <array>

#include "kinequad/core/types.h"
#include "kinequad/mesh/topology.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {

/// A surface known by its edge lengths alone, over the edges of a `Topology`.
/// The frame of a triangle has its origin at corner 0 and its x-axis along half-edge 0; angles are
/// in radians, counter-clockwise seen from outside. See docs/conventions.md.
struct IntrinsicMetric {
    Eigen::VectorXd edge_length;  ///< e: length of every undirected edge, in the units of the input
};

/// Edge lengths of one frame, `V` n x 3.
IntrinsicMetric metric_of(const Topology& topology, const Positions& V);

/// Lengths of the three half-edges of triangle `t`.
std::array<double, 3> side_lengths(const Topology& topology, const IntrinsicMetric& metric, int t);

/// The corners of a triangle with the given side lengths (half-edge k has length `sides[k]`) in its
/// own frame, as columns. A triangle that breaks the triangle inequality is laid out flat.
Eigen::Matrix<double, 2, 3> lay_out_triangle(const std::array<double, 3>& sides);

/// Area of a triangle from its sides, by Kahan's stable form of Heron's formula; 0 where the sides
/// break the triangle inequality.
double triangle_area(std::array<double, 3> sides);

/// Cotangents of the angles opposite of the half-edges; the area is bounded from below, by 1e-7 of
/// the square of the longest side, so that those of slivers stay finite; 0
/// where all sides are.
std::array<double, 3> opposite_cotangents(const std::array<double, 3>& sides);

/// Angles at the corners of a triangle with the given sides, in radians; (0, 0, pi) or a
/// permutation of it where the sides break the triangle inequality.
std::array<double, 3> corner_angles(const std::array<double, 3>& sides);

/// Directions of the three half-edges of a triangle in its own frame, in radians: 0 for the first.
std::array<double, 3> half_edge_directions(const std::array<double, 3>& sides);

/// Areas of all triangles (m), in squared units of the input.
Eigen::VectorXd triangle_areas(const Topology& topology, const IntrinsicMetric& metric);

/// Angle defect of every vertex (n), in radians: 2 pi minus the angle sum, pi minus it on the
/// boundary, 0 where the vertex is isolated.
Eigen::VectorXd angle_defects(const Topology& topology, const IntrinsicMetric& metric);

/// Angle by which the frame of the triangle across `half_edge` is turned against its own triangle's
/// when both are unfolded into a common plane: a direction `x` in the frame of the triangle of
/// `half_edge` is `x + frame_rotation(...)` in the frame across it. `half_edge` must not be on the
/// boundary.
double frame_rotation(const Topology& topology, const IntrinsicMetric& metric, int half_edge);

}  // namespace kinequad
