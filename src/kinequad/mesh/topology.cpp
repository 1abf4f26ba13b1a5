#include "kinequad/mesh/topology.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"

namespace kinequad {
namespace {

void check_triangles(const Triangles& F, int vertex_count) {
    for (int t = 0; t < F.rows(); ++t) {
        for (int k = 0; k < 3; ++k) {
            if (F(t, k) < 0 || F(t, k) >= vertex_count) {
                throw InputError(
                    InputFault::mesh,
                    fmt::format("triangle {} names vertex {}, but there are {} vertices; "
                                "mend the face list",
                                t, F(t, k), vertex_count));
            }
        }
        if (F(t, 0) == F(t, 1) || F(t, 1) == F(t, 2) || F(t, 2) == F(t, 0)) {
            throw InputError(InputFault::mesh,
                             fmt::format("triangle {} repeats a vertex ({} {} {}); remove it", t,
                                         F(t, 0), F(t, 1), F(t, 2)));
        }
    }
}

/// Pairs up half-edges by sorting them on their undirected edge: no hash order, no map.
void pair_half_edges(Topology& topology) {
    const std::size_t count = topology.origin.size();
    struct Key {
        std::uint64_t edge;
        int half_edge;
    };
    std::vector<Key> keys(count);
    for (std::size_t h = 0; h < count; ++h) {
        const auto a = static_cast<std::uint64_t>(topology.origin[h]);
        const auto b = static_cast<std::uint64_t>(topology.target(static_cast<int>(h)));
        keys[h] = {std::min(a, b) << 32U | std::max(a, b), static_cast<int>(h)};
    }
    std::sort(keys.begin(), keys.end(), [](const Key& x, const Key& y) {
        return x.edge != y.edge ? x.edge < y.edge : x.half_edge < y.half_edge;
    });
    topology.twin.assign(count, -1);
    for (std::size_t i = 0; i < count;) {
        std::size_t j = i + 1;
        while (j < count && keys[j].edge == keys[i].edge) ++j;
        const int first = keys[i].half_edge;
        const int a = topology.origin[at(first)];
        const int b = topology.target(first);
        if (j - i > 2) {
            throw InputError(
                InputFault::mesh,
                fmt::format(
                    "edge {}-{} is non-manifold: triangles {}, {} and {} share it; split the "
                    "surface there",
                    a, b, first / 3, keys[i + 1].half_edge / 3, keys[i + 2].half_edge / 3));
        }
        if (j - i == 2) {
            const int second = keys[i + 1].half_edge;
            if (topology.origin[at(second)] == a) {
                throw InputError(InputFault::mesh,
                                 fmt::format("triangles {} and {} run along edge {}-{} in the same "
                                             "direction; orient the faces consistently",
                                             first / 3, second / 3, a, b));
            }
            topology.twin[at(first)] = second;
            topology.twin[at(second)] = first;
        }
        i = j;
    }
}

void number_edges(Topology& topology) {
    topology.edge.assign(topology.twin.size(), -1);
    for (std::size_t h = 0; h < topology.twin.size(); ++h) {
        const int other = topology.twin[h];
        if (other >= 0 && other < static_cast<int>(h)) {
            topology.edge[h] = topology.edge[at(other)];
        } else {
            topology.edge[h] = topology.edge_count++;
            topology.edge_half_edge.push_back(static_cast<int>(h));
        }
    }
}

/// Chooses the outgoing half-edge of every vertex and checks that its triangles form a single fan.
void link_vertices(Topology& topology) {
    std::vector<int> degree(at(topology.vertex_count), 0);
    topology.vertex_half_edge.assign(at(topology.vertex_count), -1);
    for (std::size_t h = 0; h < topology.origin.size(); ++h) {
        const int v = topology.origin[h];
        ++degree[at(v)];
        int& chosen = topology.vertex_half_edge[at(v)];
        if (chosen < 0 || (topology.twin[h] < 0 && topology.twin[at(chosen)] >= 0)) {
            chosen = static_cast<int>(h);
        }
    }
    for (int v = 0; v < topology.vertex_count; ++v) {
        const int start = topology.vertex_half_edge[at(v)];
        if (start < 0) continue;
        int reached = 0;
        int h = start;
        do {
            ++reached;
            h = topology.rotate_counter_clockwise(h);
        } while (h >= 0 && h != start && reached <= degree[at(v)]);
        if (reached != degree[at(v)]) {
            throw InputError(
                InputFault::mesh,
                fmt::format("vertex {} is non-manifold: its {} triangles form more than "
                            "one fan; duplicate the vertex, one copy a fan",
                            v, degree[at(v)]));
        }
    }
}

}  // namespace

Topology build_topology(const Triangles& F, int vertex_count) {
    check_triangles(F, vertex_count);
    Topology topology;
    topology.vertex_count = vertex_count;
    topology.triangle_count = static_cast<int>(F.rows());
    topology.origin.assign(F.data(), F.data() + F.size());
    pair_half_edges(topology);
    number_edges(topology);
    link_vertices(topology);
    return topology;
}

std::vector<int> outgoing_half_edges(const Topology& topology, int vertex) {
    std::vector<int> result;
    const int start = topology.vertex_half_edge[at(vertex)];
    for (int h = start; h >= 0;) {
        result.push_back(h);
        h = topology.rotate_counter_clockwise(h);
        if (h == start) break;
    }
    return result;
}

std::vector<int> triangle_components(const Topology& topology) {
    std::vector<int> component(at(topology.triangle_count), -1);
    std::vector<int> stack;
    int count = 0;
    for (int seed = 0; seed < topology.triangle_count; ++seed) {
        if (component[at(seed)] >= 0) continue;
        component[at(seed)] = count;
        stack.push_back(seed);
        while (!stack.empty()) {
            const int t = stack.back();
            stack.pop_back();
            for (int k = 0; k < 3; ++k) {
                const int other = topology.twin[at(3 * t + k)];
                if (other < 0 || component[at(other / 3)] >= 0) continue;
                component[at(other / 3)] = count;
                stack.push_back(other / 3);
            }
        }
        ++count;
    }
    return component;
}

std::vector<std::vector<int>> boundary_loops(const Topology& topology) {
    std::vector<std::vector<int>> loops;
    std::vector<bool> visited(topology.twin.size(), false);
    for (std::size_t start = 0; start < topology.twin.size(); ++start) {
        if (topology.twin[start] >= 0 || visited[start]) continue;
        std::vector<int> loop;
        int h = static_cast<int>(start);
        while (!visited[at(h)]) {
            visited[at(h)] = true;
            loop.push_back(h);
            h = topology.vertex_half_edge[at(topology.target(h))];
        }
        loops.push_back(std::move(loop));
    }
    return loops;
}

SurfaceCounts count_surface(const Topology& topology) {
    SurfaceCounts counts;
    counts.vertices = static_cast<int>(std::count_if(topology.vertex_half_edge.begin(),
                                                     topology.vertex_half_edge.end(),
                                                     [](int h) { return h >= 0; }));
    counts.edges = topology.edge_count;
    counts.triangles = topology.triangle_count;
    const std::vector<int> component = triangle_components(topology);
    counts.components =
        component.empty() ? 0 : 1 + *std::max_element(component.begin(), component.end());
    counts.boundary_loops = static_cast<int>(boundary_loops(topology).size());
    counts.euler_characteristic = counts.vertices - counts.edges + counts.triangles;
    return counts;
}

std::vector<int> boundary_edges(const Topology& topology) {
    std::vector<int> edges;
    for (int e = 0; e < topology.edge_count; ++e) {
        if (topology.is_boundary_edge(e)) edges.push_back(e);
    }
    return edges;
}

}  // namespace kinequad
