#pragma once

#include <vector>

#include "kinequad/core/types.h"
#include "kinequad/mesh/refined_mesh.h"
#include "kinequad/mesh/topology.h"

namespace kinequad {

/// An integer-grid map: (u, v) at every corner of a refined mesh, so that each triangle is mapped
/// with positive area and crossing an edge is a quarter-turn rotation plus an integer translation.
///
/// Coordinates are fixed-point numbers in units of 2^-`fraction_bits` of the grid, so that
/// transition functions hold to the last bit and orientation tests are exact in 128-bit integers.
struct GridMap {
    static constexpr int fraction_bits = 30;
    static constexpr std::int64_t one = std::int64_t{1} << fraction_bits;

    /// A point of the parameter plane in fixed-point units.
    struct Coordinate {
        std::int64_t u = 0;
        std::int64_t v = 0;
        bool operator==(const Coordinate&) const = default;
    };
    /// `z -> i^rotation z + (u, v)`; the translation is a whole number of grid cells.
    struct Transition {
        int rotation = 0;  ///< quarter turns counter-clockwise, 0..3
        Coordinate translation;
        Coordinate operator()(Coordinate z) const;
        bool operator==(const Transition&) const = default;
    };

    RefinedMesh mesh;
    Topology topology;                   ///< of `mesh`
    std::vector<Coordinate> corner;      ///< 3m': coordinates of corner k of triangle t at 3t+k
    std::vector<Transition> transition;  ///< 3m': of half-edge h, from its triangle's chart to the
                                         ///< chart across it; identity on the boundary
    Eigen::VectorXi index;               ///< n': singularity index in quarters
    std::vector<char> is_line;  ///< 3m': nonzero where a half-edge inside has to lie on an integer
                                ///< line, as the boundary does; empty for none
    /// Of the features of the surface that was mapped, the edges (ascending) that lie on integer
    /// lines.
    std::vector<int> feature_edges;
    int lost_line_edges = 0;  ///< edges that had to lie on integer lines and do not, as no map of
                              ///< their part has them there
    double wanted_quads = 0;  ///< number of quads that was asked for
    double quads = 0;         ///< number of quads, the area of the map in cells
};

/// The coordinate turned counter-clockwise by `quarters` quarter turns.
GridMap::Coordinate rotate(GridMap::Coordinate z, int quarters);

/// What `verify_grid_map` counts; a valid map has zeros everywhere.
struct GridMapReport {
    int flipped_triangles = 0;   ///< triangles whose image has no positive area
    int broken_transitions = 0;  ///< edges whose two sides do not match under the transition
    int fractional_translations =
        0;  ///< half-edges whose translation is not a whole number of cells
    int fractional_singularities =
        0;                      ///< singular vertices and boundary corners off the integer grid
    int wrong_cone_angles = 0;  ///< vertices whose angle sum in the map is not (4 - index) quarters
                                ///< (on the boundary (2 - index) quarters)
    int unaligned_edges = 0;    ///< half-edges on the boundary or a line off the integer lines
    bool valid() const;
};

/// Checks every condition of an integer-grid map exactly. docs/gridmap.md
GridMapReport verify_grid_map(const GridMap& map);

}  // namespace kinequad
