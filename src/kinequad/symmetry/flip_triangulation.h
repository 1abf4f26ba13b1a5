#pragma once

#include <vector>

#include "kinequad/core/index.h"
#include "kinequad/mesh/intrinsic_metric.h"

namespace kinequad {

/// An intrinsic triangulation that edges can be flipped in. Half-edges are numbered as in
/// `Topology`; an edge may join a vertex to itself and two vertices may share several edges.
struct FlipTriangulation {
    std::vector<int> origin;     ///< 3m
    std::vector<int> twin;       ///< 3m, -1 on the boundary
    std::vector<int> edge;       ///< 3m
    std::vector<int> half_edge;  ///< e: one of the half-edges of an edge
    std::vector<double> length;  ///< e: unscaled length

    static int next(int h) { return Topology::next(h); }
    static int previous(int h) { return Topology::previous(h); }
    int target(int h) const { return origin[at(next(h))]; }
    int opposite(int h) const { return origin[at(previous(h))]; }
};

FlipTriangulation make_flip_triangulation(const Topology& topology, const IntrinsicMetric& metric);

/// How the length of the new edge follows from those of the old: `euclidean` keeps the flat
/// metric, `ptolemy` keeps the discrete conformal structure [Springborn 2020].
enum class FlipRule { euclidean, ptolemy };

/// Flips edges until every edge is Delaunay in the lengths `scale[a] * scale[b] * length`, and
/// returns how often it flipped. `scale` n positive numbers. Lengths need not satisfy the triangle
/// inequality under the rule `ptolemy`.
int flip_to_delaunay(FlipTriangulation& mesh, const Eigen::VectorXd& scale, FlipRule rule);

/// Scaled lengths of the half-edges of triangle `t`.
std::array<double, 3> scaled_sides(const FlipTriangulation& mesh, const Eigen::VectorXd& scale,
                                   int t);

}  // namespace kinequad
