#pragma once

#include "kinequad/io/polygons.h"

namespace kinequad {

/// What there is in a mesh of polygons that may be broken in any way; positions do not matter.
struct MeshCounts {
    int vertices = 0;  ///< vertices that a face uses
    int edges = 0;
    int faces = 0;
    int quads = 0;
    int triangles = 0;
    int other_faces = 0;  ///< faces with five corners or more
    /// Vertices where the number of edges is not 4 inside, not 3 on the boundary. A vertex is on
    /// the boundary where one of its edges has a single face.
    int irregular_vertices = 0;
    int boundary_edges = 0;         ///< edges with a single face
    int boundary_loops = 0;         ///< connected parts of the graph of boundary edges
    int non_manifold_edges = 0;     ///< edges with more than two faces
    int non_manifold_vertices = 0;  ///< vertices whose faces form more than one fan
    int misoriented_edges = 0;      ///< edges that two faces run along in the same direction
    int components = 0;             ///< parts connected by edges or vertices
    int euler_characteristic = 0;   ///< vertices - edges + faces
    int duplicate_faces = 0;        ///< faces with the same vertices as an earlier one

    double quad_percent() const { return faces > 0 ? 100.0 * quads / faces : 0; }
    double irregular_percent() const {
        return vertices > 0 ? 100.0 * irregular_vertices / vertices : 0;
    }
    bool is_manifold() const { return non_manifold_edges == 0 && non_manifold_vertices == 0; }
};

/// Counts the elements of `faces` over `vertex_count` vertices. Throws as `check_polygons`.
MeshCounts count_mesh(const Polygons& faces, int vertex_count);

}  // namespace kinequad
