#include "kinequad/pipeline/domain.h"

#include "kinequad/core/index.h"
#include "kinequad/extract/quad_topology.h"

namespace kinequad {

std::vector<int> Domain::curve_edges() const {
    std::vector<int> edges;
    const auto is_on_curve = [&](int v) { return surface.is_on_curve[at(v)] != 0; };
    for (int e = 0; e < topology.edge_count; ++e) {
        const int h = topology.edge_half_edge[at(e)];
        if (!is_on_curve(topology.origin[at(h)])) continue;
        if (!is_on_curve(topology.target(h))) continue;
        if (!is_half() || topology.is_boundary_edge(e)) edges.push_back(e);
    }
    return edges;
}

std::vector<char> curve_vertices(const QuadMesh& quads, const Domain& domain) {
    const QuadTopology topology =
        build_quad_topology(quads.Q, static_cast<int>(quads.vertex.size()));
    std::vector<char> result;
    for (int v = 0; v < topology.vertex_count; ++v) {
        const SurfacePoint& point = quads.vertex[at(v)];
        const bool is_on_curve =
            topology.is_boundary_vertex(v) && lies_on_curve(domain.surface, domain.topology, point);
        result.push_back(is_on_curve ? 1 : 0);
    }
    return result;
}

}  // namespace kinequad
