#include "kinequad/symmetry/cut_handles.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>

#include "kinequad/core/index.h"

namespace kinequad {
namespace {

constexpr double unreached = std::numeric_limits<double>::infinity();

/// A closed chain of half-edges.
struct Loop {
    std::vector<int> half_edge;
    double length = unreached;
};

/// Shortest paths from one vertex: the half-edge that each vertex is reached by, -1 at the root.
struct PathTree {
    std::vector<double> distance;
    std::vector<int> reached_by;
};

PathTree grow_tree(const Topology& topology, const std::vector<double>& side, int root) {
    PathTree tree;
    tree.distance.assign(at(topology.vertex_count), unreached);
    tree.reached_by.assign(at(topology.vertex_count), -1);
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    tree.distance[at(root)] = 0;
    queue.emplace(0.0, root);
    while (!queue.empty()) {
        const auto [d, v] = queue.top();
        queue.pop();
        if (d > tree.distance[at(v)]) continue;
        for (const int h : outgoing_half_edges(topology, v)) {
            const int w = topology.target(h);
            if (d + side[at(h)] >= tree.distance[at(w)]) continue;
            tree.distance[at(w)] = d + side[at(h)];
            tree.reached_by[at(w)] = h;
            queue.emplace(tree.distance[at(w)], w);
        }
    }
    return tree;
}

/// Path of half-edges from the root to a vertex.
std::vector<int> path_to(const Topology& topology, const PathTree& tree, int vertex) {
    std::vector<int> path;
    for (int h = tree.reached_by[at(vertex)]; h >= 0;
         h = tree.reached_by[at(topology.origin[at(h)])]) {
        path.push_back(h);
    }
    std::reverse(path.begin(), path.end());
    return path;
}

/// The shortest loop that closes the shortest paths from `root` and does not separate the surface.
Loop shortest_loop_from(const Topology& topology, const std::vector<double>& side, int root) {
    const PathTree tree = grow_tree(topology, side, root);
    std::vector<bool> is_used(at(topology.edge_count), false);
    for (const int h : tree.reached_by) {
        if (h >= 0) is_used[at(topology.edge[at(h)])] = true;
    }
    // A spanning tree of the triangles over the edges left; the few edges in neither close loops.
    std::vector<bool> is_reached(at(topology.triangle_count), false);
    std::vector<int> queue;
    for (int seed = 0; seed < topology.triangle_count; ++seed) {
        if (is_reached[at(seed)]) continue;
        is_reached[at(seed)] = true;
        queue.assign(1, seed);
        for (std::size_t i = 0; i < queue.size(); ++i) {
            for (int h = 3 * queue[i]; h < 3 * queue[i] + 3; ++h) {
                const int other = topology.twin[at(h)];
                if (other < 0 || is_used[at(topology.edge[at(h)])] || is_reached[at(other / 3)]) {
                    continue;
                }
                is_used[at(topology.edge[at(h)])] = true;
                is_reached[at(other / 3)] = true;
                queue.push_back(other / 3);
            }
        }
    }
    Loop best;
    for (int e = 0; e < topology.edge_count; ++e) {
        if (is_used[at(e)]) continue;
        const int h = topology.edge_half_edge[at(e)];
        if (topology.twin[at(h)] < 0) continue;
        std::vector<int> there = path_to(topology, tree, topology.origin[at(h)]);
        std::vector<int> back = path_to(topology, tree, topology.target(h));
        // What both paths share at the root is no part of the loop.
        std::size_t shared = 0;
        while (shared < std::min(there.size(), back.size()) && there[shared] == back[shared]) {
            ++shared;
        }
        Loop loop;
        loop.half_edge.assign(there.begin() + static_cast<long>(shared), there.end());
        loop.half_edge.push_back(h);
        for (std::size_t i = back.size(); i > shared; --i) {
            loop.half_edge.push_back(topology.twin[at(back[i - 1])]);
        }
        loop.length = 0;
        for (const int g : loop.half_edge) loop.length += side[at(g)];
        if (loop.length < best.length) best = std::move(loop);
    }
    return best;
}

Loop find_short_loop(const Topology& topology, const std::vector<double>& side,
                     const Context& context) {
    // Far-apart roots see every handle from nearby.
    std::vector<int> roots;
    std::vector<double> nearest(at(topology.vertex_count), unreached);
    int root = topology.origin.front();
    for (int i = 0; i < 10; ++i) {
        context.check_cancelled();
        roots.push_back(root);
        const PathTree tree = grow_tree(topology, side, root);
        double farthest = -1;
        for (int v = 0; v < topology.vertex_count; ++v) {
            nearest[at(v)] = std::min(nearest[at(v)], tree.distance[at(v)]);
            if (std::isfinite(nearest[at(v)]) && nearest[at(v)] > farthest) {
                farthest = nearest[at(v)];
                root = v;
            }
        }
    }
    Loop best;
    for (int round = 0; round < 6; ++round) {
        const double before = best.length;
        for (const int v : roots) {
            context.check_cancelled();
            Loop loop = shortest_loop_from(topology, side, v);
            if (loop.length < best.length) best = std::move(loop);
        }
        if (!(best.length < before)) break;
        roots.clear();
        const std::size_t step = std::max<std::size_t>(1, best.half_edge.size() / 6);
        for (std::size_t i = 0; i < best.half_edge.size(); i += step) {
            roots.push_back(topology.origin[at(best.half_edge[i])]);
        }
    }
    return best;
}

/// Gives the triangles right of the loop copies of its vertices.
void cut_along(const Topology& topology, const Loop& loop, CutSurface& surface) {
    const std::size_t count = loop.half_edge.size();
    for (std::size_t i = 0; i < count; ++i) {
        const int leaving = loop.half_edge[i];
        const int arriving = loop.half_edge[(i + count - 1) % count];
        const int copy = surface.vertex_count++;
        // Clockwise from the loop's next half-edge to its last one lies the right side.
        for (int h = topology.rotate_clockwise(leaving); h >= 0; h = topology.rotate_clockwise(h)) {
            surface.F(h / 3, h % 3) = copy;
            if (h == topology.twin[at(arriving)]) break;
        }
    }
}

}  // namespace

CutSurface cut_handles(const Triangles& F, int vertex_count, const std::vector<double>& side,
                       const Context& context) {
    CutSurface surface{F, vertex_count};
    const SurfaceCounts counts = count_surface(build_topology(F, vertex_count));
    const int holes = counts.boundary_loops;
    int genus = (2 * counts.components - counts.euler_characteristic - holes) / 2;
    for (; genus > 0; --genus) {
        const Topology topology = build_topology(surface.F, surface.vertex_count);
        const Loop loop = find_short_loop(topology, side, context);
        if (!std::isfinite(loop.length)) break;
        cut_along(topology, loop, surface);
    }
    return surface;
}

}  // namespace kinequad
