#pragma once

#include <vector>

#include "kinequad/gridmap/charted_mesh.h"
#include "kinequad/gridmap/linear_elimination.h"

namespace kinequad {

/// The degrees of freedom of a map with the rotations of a `ChartedMesh`, and how the coordinates
/// of every corner follow from them. docs/gridmap.md, "Variables".
///
/// Columns [0, vertex_columns) are coordinates of regular vertices; the `chain_columns` after them
/// are translations along the chains of the cut, to which the singular vertices and the boundary
/// lines are tied. The chain columns are real unknowns of the seamless map; the integer-grid maps
/// among them are the integer combinations of the columns of `lattice`.
struct MapVariables {
    int vertex_columns = 0;
    int chain_columns = 0;
    /// Compressed rows, two a corner (u, then v): coordinate = sum coefficient * column.
    std::vector<int> row_start;
    std::vector<int> column;
    std::vector<double> coefficient;

    /// Positions that have to become whole numbers: coordinates of nodes, boundary and lines, and
    /// the translations of the cut, as forms in the chain columns (numbered from 0).
    std::vector<LinearForm<double>> whole;
    int position_count = 0;  ///< the first of `whole` are coordinates, the others translations
    /// chain_columns x p: chain columns from the p integer unknowns.
    Eigen::MatrixXd lattice;
    /// p x 2-forms: the part of every corner's coordinates that the integer unknowns give; empty
    /// off the cut and the nodes. Two a corner.
    std::vector<LinearForm<long>> integer_part;
    /// n: nonzero at nodes, the vertices with integer coordinates: singular vertices, corners of
    /// the boundary, ends, corners and crossings of lines, and one vertex where a boundary loop, a
    /// closed line or a component has none.
    std::vector<char> is_node;

    int columns() const { return vertex_columns + chain_columns; }
    int integer_count() const { return static_cast<int>(lattice.cols()); }
    /// Coordinates of every corner (3m) for the values `x` of all columns.
    std::vector<Complex> corner_coordinates(const Eigen::VectorXd& x) const;
};

/// Vertices that get integer coordinates.
std::vector<char> find_nodes(const ChartedMesh& mesh);

/// Sets up the variables over a mesh whose charts have been combed by `cut_to_discs`.
/// Throws `GridMapError` where the field is not aligned with the boundary.
MapVariables build_map_variables(const ChartedMesh& mesh, const CutGraph& cut,
                                 const std::vector<char>& nodes);

}  // namespace kinequad
