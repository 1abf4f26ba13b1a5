#pragma once

#include "kinequad/core/index.h"
#include "kinequad/gridmap/grid_map.h"

/// Exact geometry in the charts of an integer-grid map, shared by the files of this stage.
namespace kinequad::extraction {

using Coordinate = GridMap::Coordinate;
/// Wide enough for the product of two differences of coordinates that pass `require_extractable`.
using Wide = __int128;

inline Coordinate minus(Coordinate a, Coordinate b) { return {a.u - b.u, a.v - b.v}; }

inline Wide cross(Coordinate a, Coordinate b) {
    return static_cast<Wide>(a.u) * b.v - static_cast<Wide>(a.v) * b.u;
}

inline bool is_whole(Coordinate z) {
    constexpr std::int64_t mask = GridMap::one - 1;
    return ((z.u | z.v) & mask) == 0;
}

/// Coordinates of the corner that half-edge `h` starts from, in the chart of its triangle.
inline Coordinate corner_of(const GridMap& map, int h) { return map.corner[at(h)]; }

/// `z` seen from `from` when looking along direction i^`direction`: u is ahead, v to the left.
inline Coordinate seen_from(Coordinate z, Coordinate from, int direction) {
    return rotate(minus(z, from), 4 - direction);
}

/// The directions of the two sides of the corner `h` as seen along direction i^`direction`.
struct CornerView {
    Coordinate first;  ///< along half-edge h
    Coordinate last;   ///< along the other side, against the half-edge before h
};

inline CornerView view_corner(const GridMap& map, int h, int direction) {
    const Coordinate from = corner_of(map, h);
    return {seen_from(corner_of(map, Topology::next(h)), from, direction),
            seen_from(corner_of(map, Topology::previous(h)), from, direction)};
}

/// Whether the direction runs along the first side of the corner.
inline bool is_along_first_side(const CornerView& view) {
    return view.first.v == 0 && view.first.u > 0;
}
/// Whether the direction runs along the last side of the corner.
inline bool is_along_last_side(const CornerView& view) {
    return view.last.v == 0 && view.last.u > 0;
}
/// Whether the direction lies in the corner's sector, first side included and last side excluded,
/// so that the corners around a vertex share out all directions without overlap.
inline bool is_in_sector(const CornerView& view) {
    return (view.first.v < 0 && view.last.v > 0) || is_along_first_side(view);
}

}  // namespace kinequad::extraction
