#include "kinequad/field/singularities.h"

#include "kinequad/core/index.h"

namespace kinequad {

std::vector<Singularity> list_singularities(const Topology& topology, const CrossField& field) {
    std::vector<Singularity> result;
    for (int v = 0; v < topology.vertex_count; ++v) {
        if (field.index[v] == 0) continue;
        result.push_back({v, field.index[v], topology.is_boundary_vertex(v)});
    }
    return result;
}

int count_adjacent_singularities(const Topology& topology, const CrossField& field) {
    int count = 0;
    for (const int h : topology.edge_half_edge) {
        const int a = topology.origin[at(h)];
        if (field.index[a] != 0 && field.index[topology.target(h)] != 0) ++count;
    }
    return count;
}

}  // namespace kinequad
