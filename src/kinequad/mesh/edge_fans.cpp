#include "kinequad/mesh/edge_fans.h"

#include <algorithm>
#include <numeric>

#include "kinequad/core/disjoint_sets.h"
#include "kinequad/core/index.h"
#include "kinequad/mesh/topology.h"

namespace kinequad {
namespace {

int origin(const Triangles& F, int h) { return F.data()[h]; }

}  // namespace

bool EdgeFan::runs_one_way(const Triangles& F) const {
    const auto forward = std::count_if(half_edges.begin(), half_edges.end(),
                                       [&](int h) { return origin(F, h) == a; });
    return forward > 1 || static_cast<int>(half_edges.size()) - forward > 1;
}

std::vector<EdgeFan> find_edge_fans(const Triangles& F, const std::vector<int>& triangles) {
    struct Key {
        int a;
        int b;
        int half_edge;
    };
    std::vector<Key> keys;
    keys.reserve(3 * triangles.size());
    for (const int t : triangles) {
        for (int h = 3 * t; h < 3 * t + 3; ++h) {
            const auto [a, b] = std::minmax({origin(F, h), origin(F, Topology::next(h))});
            keys.push_back({a, b, h});
        }
    }
    std::sort(keys.begin(), keys.end(), [](const Key& x, const Key& y) {
        return std::array<int, 3>{x.a, x.b, x.half_edge} <
               std::array<int, 3>{y.a, y.b, y.half_edge};
    });
    std::vector<EdgeFan> fans;
    for (const Key& key : keys) {
        if (fans.empty() || fans.back().a != key.a || fans.back().b != key.b) {
            fans.push_back({key.a, key.b, {}});
        }
        fans.back().half_edges.push_back(key.half_edge);
    }
    std::sort(fans.begin(), fans.end(), [](const EdgeFan& x, const EdgeFan& y) {
        return x.half_edges.front() < y.half_edges.front();
    });
    return fans;
}

std::vector<std::array<int, 2>> find_duplicate_triangles(const Triangles& F,
                                                         const std::vector<int>& triangles) {
    struct Key {
        std::array<int, 3> vertices;
        int triangle;
    };
    std::vector<Key> keys;
    keys.reserve(triangles.size());
    for (const int t : triangles) {
        std::array<int, 3> vertices = {F(t, 0), F(t, 1), F(t, 2)};
        std::sort(vertices.begin(), vertices.end());
        keys.push_back({vertices, t});
    }
    std::sort(keys.begin(), keys.end(), [](const Key& x, const Key& y) {
        return x.vertices != y.vertices ? x.vertices < y.vertices : x.triangle < y.triangle;
    });
    std::vector<std::array<int, 2>> pairs;
    for (std::size_t i = 1, first = 0; i < keys.size(); ++i) {
        if (keys[i].vertices == keys[first].vertices) {
            pairs.push_back({keys[first].triangle, keys[i].triangle});
        } else {
            first = i;
        }
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

FanCorners group_corners(const Triangles& F, const std::vector<int>& triangles) {
    DisjointSets fans(at(F.size()));
    for (const EdgeFan& edge : find_edge_fans(F, triangles)) {
        for (const int vertex : {edge.a, edge.b}) {
            const auto corner_at = [&](int h) {
                return origin(F, h) == vertex ? h : Topology::next(h);
            };
            const int first = corner_at(edge.half_edges.front());
            for (const int h : edge.half_edges) fans.unite(first, corner_at(h));
        }
    }
    FanCorners corners;
    corners.fan.assign(at(F.size()), -1);
    for (const int t : triangles) {
        for (int h = 3 * t; h < 3 * t + 3; ++h) corners.fan[at(h)] = fans.find(h);
    }
    return corners;
}

std::vector<int> FanCorners::vertices_with_several_fans(const Triangles& F,
                                                        int vertex_count) const {
    std::vector<int> fans(at(vertex_count), 0);
    for (int h = 0; h < static_cast<int>(fan.size()); ++h) {
        if (fan[at(h)] == h) ++fans[at(origin(F, h))];
    }
    std::vector<int> vertices;
    for (int v = 0; v < vertex_count; ++v) {
        if (fans[at(v)] > 1) vertices.push_back(v);
    }
    return vertices;
}

PartOrientation orient_parts(const Triangles& F, const std::vector<int>& triangles) {
    const std::size_t corners = at(static_cast<int>(F.size()));
    std::vector<int> twin(corners, -1);
    for (const EdgeFan& edge : find_edge_fans(F, triangles)) {
        if (edge.half_edges.size() != 2) continue;
        twin[at(edge.half_edges[0])] = edge.half_edges[1];
        twin[at(edge.half_edges[1])] = edge.half_edges[0];
    }
    PartOrientation result;
    result.is_turned.assign(corners / 3, 0);
    std::vector<char> seen(corners / 3, 0);
    for (const int seed : triangles) {
        if (seen[at(seed)] != 0) continue;
        seen[at(seed)] = 1;
        std::vector<int> part = {seed};
        bool is_orientable = true;
        for (std::size_t i = 0; i < part.size(); ++i) {
            for (int h = 3 * part[i]; h < 3 * part[i] + 3; ++h) {
                const int other = twin[at(h)];
                if (other < 0) continue;
                const bool agrees = origin(F, h) != origin(F, other);
                const char turned = static_cast<char>(agrees ? result.is_turned[at(h / 3)]
                                                             : 1 - result.is_turned[at(h / 3)]);
                if (seen[at(other / 3)] == 0) {
                    seen[at(other / 3)] = 1;
                    result.is_turned[at(other / 3)] = turned;
                    part.push_back(other / 3);
                } else if (result.is_turned[at(other / 3)] != turned) {
                    is_orientable = false;
                }
            }
        }
        const auto turned = std::count_if(part.begin(), part.end(),
                                          [&](int t) { return result.is_turned[at(t)] != 0; });
        if (!is_orientable) result.unorientable.push_back(seed);
        if (!is_orientable || 2 * static_cast<std::size_t>(turned) > part.size()) {
            for (const int t : part) {
                result.is_turned[at(t)] =
                    static_cast<char>(is_orientable ? 1 - result.is_turned[at(t)] : 0);
            }
        }
    }
    return result;
}

}  // namespace kinequad
