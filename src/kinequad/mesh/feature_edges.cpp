#include "kinequad/mesh/feature_edges.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/core/sort_unique.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {

std::vector<int> find_feature_edges(const Topology& topology, const Positions& V, double degrees) {
    const auto normal_of = [&](int t) -> Vector3 {
        const auto corner = [&](int k) -> Vector3 {
            return V.row(topology.origin[at(3 * t + k)]).transpose();
        };
        return triangle_area_vector(corner(0), corner(1), corner(2));
    };
    const double limit = degrees * std::numbers::pi / 180;
    std::vector<int> features;
    for (int e = 0; e < topology.edge_count; ++e) {
        if (topology.is_boundary_edge(e)) continue;
        const int h = topology.edge_half_edge[at(e)];
        const Vector3 left = normal_of(h / 3);
        const Vector3 right = normal_of(topology.twin[at(h)] / 3);
        if (left.squaredNorm() == 0 || right.squaredNorm() == 0) continue;
        if (std::atan2(left.cross(right).norm(), left.dot(right)) > limit) features.push_back(e);
    }
    return features;
}

std::vector<int> edges_between(const Topology& topology,
                               const std::vector<std::array<int, 2>>& pairs,
                               const std::string& name) {
    std::vector<int> edges;
    for (const auto& [a, b] : pairs) {
        int found = -1;
        const bool exist = std::max(a, b) < topology.vertex_count && std::min(a, b) >= 0;
        if (exist && topology.vertex_half_edge[at(a)] >= 0) {
            for (const int h : outgoing_half_edges(topology, a)) {
                const int before = Topology::previous(h);
                // The last edge around a vertex of the boundary has no half-edge that leaves it.
                if (topology.target(h) == b) found = topology.edge[at(h)];
                if (topology.origin[at(before)] == b) found = topology.edge[at(before)];
            }
        }
        if (found < 0) {
            throw InputError(
                InputFault::usage,
                fmt::format("{}: the mesh has no edge between vertices {} and {}", name, a, b));
        }
        edges.push_back(found);
    }
    sort_unique(edges);
    return edges;
}

std::vector<int> edges_along(const Topology& topology, const RefinedMesh& fine,
                             const Topology& coarse, const std::vector<int>& edges) {
    std::vector<char> is_listed(at(coarse.edge_count), 0);
    for (const int e : edges) is_listed[at(e)] = 1;
    std::vector<int> found;
    for (int e = 0; e < topology.edge_count; ++e) {
        const int h = topology.edge_half_edge[at(e)];
        const int side = side_of_parent(fine, h);
        if (side >= 0 && is_listed[at(coarse.edge[at(side)])]) found.push_back(e);
    }
    return found;
}

}  // namespace kinequad
