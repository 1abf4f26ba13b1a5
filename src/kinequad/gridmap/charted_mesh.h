#pragma once

#include <vector>

#include "kinequad/core/types.h"
#include "kinequad/field/cross_field.h"
#include "kinequad/mesh/intrinsic_metric.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {

/// The working mesh of the grid map: a triangulation that may be refined, with a chart in every
/// triangle whose axes are the arms of the cross and whose unit is the wanted edge length. A map
/// that equals the chart in every triangle up to translation would have no distortion at all.
/// Half-edge `h = 3 * t + k` as in `Topology`.
struct ChartedMesh {
    static constexpr char feature_line = 2;

    int vertex_count = 0;
    std::vector<int> origin;    ///< 3m: vertex at a corner
    std::vector<int> twin;      ///< 3m: half-edge across, -1 on the boundary
    std::vector<int> rotation;  ///< 3m: quarter turns from this triangle's chart to the one across
    std::vector<Complex> target;  ///< 3m: corner in the chart of its triangle, in cells
    std::vector<char> is_line;    ///< 3m: nonzero on both half-edges of an edge inside the surface
                                  ///< that has to lie on an integer line: `feature_line` where it
                                  ///< may be given up, else 1
    std::vector<int> parent;      ///< m: input triangle
    std::vector<Vector3> barycentric;  ///< 3m: corner in the parent's barycentric coordinates
    std::vector<int> index;            ///< n: singularity index in quarters
    std::vector<char> is_boundary;     ///< n

    int triangle_count() const { return static_cast<int>(parent.size()); }
    /// Inserts a vertex at `fraction` of half-edge `half_edge` (0 at its origin) and returns it.
    /// The triangles on both sides are cut in two; half-edge numbers of all other triangles stay.
    int split_edge(int half_edge, double fraction = 0.5);
    /// Half-edges that leave every vertex, one a vertex: the boundary one where there is one, else
    /// one on a line, else any.
    std::vector<int> first_half_edges() const;
    /// The triangles (m x 3).
    Triangles triangles() const;
};

/// Lays the charts out along the crosses of `field`, one cell being `edge_length` long. The edges
/// `line_edges` inside the surface have to lie on integer lines, as its boundary does;
/// `feature_edges` may be given up.
ChartedMesh build_charts(const Topology& topology, const IntrinsicMetric& metric,
                         const CrossField& field, double edge_length,
                         const std::vector<int>& line_edges = {},
                         const std::vector<int>& feature_edges = {});

/// Gives up feature lines next to which there is no room for the quads of a map: where two lines
/// leave a vertex less than half a quarter turn of the crosses apart. Returns the number of edges.
int give_up_narrow_lines(ChartedMesh& mesh);

/// Gives up the feature lines at the corners of `triangles`. Returns the number of edges.
int give_up_lines_at(ChartedMesh& mesh, const std::vector<int>& triangles);

/// Splits every edge that joins two singular vertices, and every triangle with three, until there
/// is none: the map could not pass a third singularity between two that an edge ties together.
/// Returns the number of splits.
int separate_singularities(ChartedMesh& mesh);

/// The chart gauge in which crossing any edge off the cut is the identity, and the cut.
struct CutGraph {
    std::vector<char> is_cut;  ///< 3m: both half-edges of every edge of the cut
};

/// Turns the charts of `mesh` so that rotations are zero across a breadth-first dual spanning tree,
/// and returns the edges that the tree does not cross, less the branches that end in regular
/// vertices: a graph that cuts the surface into discs, one a component, through all singular
/// vertices and all of `nodes` (n, nonzero where a vertex must stay on the graph).
CutGraph cut_to_discs(ChartedMesh& mesh, const std::vector<char>& nodes);

/// `z` turned counter-clockwise by `quarters` quarter turns, exact.
inline Complex turn(Complex z, int quarters) {
    switch (quarters & 3) {
        case 1:
            return {-z.imag(), z.real()};
        case 2:
            return -z;
        case 3:
            return {z.imag(), -z.real()};
        default:
            return z;
    }
}

}  // namespace kinequad
