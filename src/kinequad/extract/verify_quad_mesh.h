#pragma once

#include "kinequad/extract/quad_mesh.h"
#include "kinequad/mesh/topology.h"

namespace kinequad {

/// What `verify_quad_mesh` counts. A valid mesh has zeros in the first group and the same numbers
/// as the input surface in the second.
struct QuadMeshReport {
    int invalid_quads = 0;          ///< quads with an index out of range or a repeated vertex
    int non_manifold_edges = 0;     ///< edges of more than two quads
    int misoriented_edges = 0;      ///< edges that two quads run along in the same direction
    int non_manifold_vertices = 0;  ///< vertices whose quads form more than one fan
    int isolated_vertices = 0;      ///< vertices without quads
    int invalid_points =
        0;  ///< vertices that are no points of the input: no such triangle, or
            ///< barycentric coordinates not finite, negative, or not summing to one

    int vertices = 0;
    int quads = 0;
    int edges = 0;
    int components = 0;
    int boundary_loops = 0;
    int euler_characteristic = 0;
    /// The input's; the triangle counts are of the input, not of the quad mesh.
    SurfaceCounts input;

    bool valid() const;
};

/// Checks that a quad mesh is manifold, consistently oriented and of the topology of the input
/// surface, and that its vertices are points of it. Never throws on a bad mesh: it counts.
/// docs/extraction.md
QuadMeshReport verify_quad_mesh(const QuadMesh& mesh, const Topology& input_topology);

/// Throws `VerificationError`, naming what is wrong, unless the report is that of a valid mesh.
void require_valid(const QuadMeshReport& report);

}  // namespace kinequad
