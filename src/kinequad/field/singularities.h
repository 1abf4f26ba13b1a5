#pragma once

#include <vector>

#include "kinequad/field/cross_field.h"
#include "kinequad/mesh/topology.h"

namespace kinequad {

/// A vertex where a cross field is not regular.
struct Singularity {
    int vertex = -1;
    int index =
        0;  ///< quarters: valence 4 - index inside; 2 - index quarters of angle on the boundary
    bool boundary = false;
    bool operator==(const Singularity&) const = default;
};

/// The singularities of a field, by ascending vertex, corners of the boundary among them.
std::vector<Singularity> list_singularities(const Topology& topology, const CrossField& field);

/// Number of mesh edges that join two singularities, for which an integer-grid map has no room.
int count_adjacent_singularities(const Topology& topology, const CrossField& field);

}  // namespace kinequad
