#include "kinequad/extract/quad_topology.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"

namespace kinequad {
namespace {

void check_quads(const Quads& Q, int vertex_count) {
    for (int q = 0; q < Q.rows(); ++q) {
        for (int k = 0; k < 4; ++k) {
            if (Q(q, k) < 0 || Q(q, k) >= vertex_count) {
                throw InputError(
                    InputFault::mesh,
                    fmt::format("quad {} names vertex {}, but there are {} vertices; mend "
                                "the face list",
                                q, Q(q, k), vertex_count));
            }
            for (int j = 0; j < k; ++j) {
                if (Q(q, j) != Q(q, k)) continue;
                throw InputError(InputFault::mesh,
                                 fmt::format("quad {} repeats vertex {}; remove it", q, Q(q, k)));
            }
        }
    }
}

void pair_half_edges(QuadTopology& topology) {
    struct Key {
        std::uint64_t edge;
        int half_edge;
    };
    std::vector<Key> keys;
    keys.reserve(topology.origin.size());
    for (int h = 0; h < 4 * topology.quad_count; ++h) {
        const auto a = static_cast<std::uint64_t>(topology.origin[at(h)]);
        const auto b = static_cast<std::uint64_t>(topology.target(h));
        keys.push_back({std::min(a, b) << 32U | std::max(a, b), h});
    }
    std::sort(keys.begin(), keys.end(), [](const Key& x, const Key& y) {
        return x.edge != y.edge ? x.edge < y.edge : x.half_edge < y.half_edge;
    });
    topology.twin.assign(keys.size(), -1);
    for (std::size_t i = 0; i < keys.size();) {
        std::size_t j = i + 1;
        while (j < keys.size() && keys[j].edge == keys[i].edge) ++j;
        const int first = keys[i].half_edge;
        const int a = topology.origin[at(first)];
        const int b = topology.target(first);
        if (j - i > 2) {
            throw InputError(
                InputFault::mesh,
                fmt::format("edge {}-{} of the quad mesh is non-manifold: {} quads share it", a, b,
                            j - i));
        }
        if (j - i == 2) {
            const int second = keys[i + 1].half_edge;
            if (topology.origin[at(second)] == a) {
                throw InputError(
                    InputFault::mesh,
                    fmt::format("quads {} and {} run along edge {}-{} in the same direction; "
                                "orient the faces consistently",
                                first / 4, second / 4, a, b));
            }
            topology.twin[at(first)] = second;
            topology.twin[at(second)] = first;
        }
        i = j;
    }
}

void number_edges(QuadTopology& topology) {
    topology.edge.assign(topology.twin.size(), -1);
    for (int h = 0; h < 4 * topology.quad_count; ++h) {
        const int other = topology.twin[at(h)];
        if (other >= 0 && other < h) {
            topology.edge[at(h)] = topology.edge[at(other)];
        } else {
            topology.edge[at(h)] = topology.edge_count++;
            topology.edge_half_edge.push_back(h);
        }
    }
}

void link_vertices(QuadTopology& topology) {
    std::vector<int> quads(at(topology.vertex_count), 0);
    topology.vertex_half_edge.assign(at(topology.vertex_count), -1);
    for (int h = 0; h < 4 * topology.quad_count; ++h) {
        const int v = topology.origin[at(h)];
        ++quads[at(v)];
        int& chosen = topology.vertex_half_edge[at(v)];
        if (chosen < 0 || (topology.twin[at(h)] < 0 && topology.twin[at(chosen)] >= 0)) {
            chosen = h;
        }
    }
    topology.valence.assign(at(topology.vertex_count), 0);
    topology.neighbor.reserve(at(2 * topology.edge_count));
    for (int v = 0; v < topology.vertex_count; ++v) {
        topology.first_neighbor.push_back(static_cast<int>(topology.neighbor.size()));
        const int start = topology.vertex_half_edge[at(v)];
        if (start < 0) continue;
        int reached = 0;
        for (int h = start;;) {
            ++reached;
            topology.neighbor.push_back(topology.target(h));
            const int after = topology.rotate_counter_clockwise(h);
            if (after < 0) {
                topology.neighbor.push_back(topology.origin[at(QuadTopology::previous(h))]);
            }
            if (after < 0 || after == start || reached > quads[at(v)]) break;
            h = after;
        }
        if (reached != quads[at(v)]) {
            throw InputError(
                InputFault::mesh,
                fmt::format("vertex {} of the quad mesh is non-manifold: its {} quads form "
                            "more than one fan",
                            v, quads[at(v)]));
        }
        topology.valence[at(v)] =
            static_cast<int>(topology.neighbor.size()) - topology.first_neighbor.back();
    }
    topology.first_neighbor.push_back(static_cast<int>(topology.neighbor.size()));
}

}  // namespace

QuadTopology build_quad_topology(const Quads& Q, int vertex_count) {
    check_quads(Q, vertex_count);
    QuadTopology topology;
    topology.vertex_count = vertex_count;
    topology.quad_count = static_cast<int>(Q.rows());
    topology.origin.assign(Q.data(), Q.data() + Q.size());
    pair_half_edges(topology);
    number_edges(topology);
    link_vertices(topology);
    return topology;
}

int count_irregular_vertices(const QuadTopology& topology) {
    int count = 0;
    for (int v = 0; v < topology.vertex_count; ++v)
        count += topology.is_irregular_vertex(v) ? 1 : 0;
    return count;
}

}  // namespace kinequad
