#include "kinequad/gridmap/charted_mesh.h"

#include <array>
#include <cmath>

#include "kinequad/core/index.h"

namespace kinequad {
namespace {

/// Copies the corner data of `from` to `to`, without connectivity.
void copy_corner(ChartedMesh& mesh, std::size_t from, std::size_t to) {
    mesh.origin[to] = mesh.origin[from];
    mesh.target[to] = mesh.target[from];
    mesh.barycentric[to] = mesh.barycentric[from];
}

void glue(ChartedMesh& mesh, int h, int other, int rotation) {
    mesh.twin[at(h)] = other;
    mesh.rotation[at(h)] = rotation & 3;
    if (other >= 0) {
        mesh.twin[at(other)] = h;
        mesh.rotation[at(other)] = -rotation & 3;
    }
}

/// Cuts the triangle of half-edge `h = a -> b` with apex c into (a, w, c), in place, and (w, b, c),
/// returning the half-edge w -> b of the latter. The cut edges themselves are left unglued.
int halve_triangle(ChartedMesh& mesh, int h, double fraction, int w) {
    const int n = Topology::next(h);
    const int p = Topology::previous(h);
    const int fresh = 3 * mesh.triangle_count();
    mesh.parent.push_back(mesh.parent[at(h / 3)]);
    const std::size_t corners = mesh.origin.size() + 3;
    mesh.origin.resize(corners);
    mesh.twin.resize(corners, -1);
    mesh.rotation.resize(corners, 0);
    mesh.target.resize(corners);
    mesh.barycentric.resize(corners);
    mesh.is_line.resize(corners, 0);
    mesh.is_line[at(fresh)] = mesh.is_line[at(h)];
    mesh.is_line[at(fresh + 1)] = mesh.is_line[at(n)];
    mesh.is_line[at(n)] = 0;

    copy_corner(mesh, at(n), at(fresh + 1));
    copy_corner(mesh, at(p), at(fresh + 2));
    mesh.origin[at(fresh)] = w;
    mesh.target[at(fresh)] = (1 - fraction) * mesh.target[at(h)] + fraction * mesh.target[at(n)];
    mesh.barycentric[at(fresh)] =
        (1 - fraction) * mesh.barycentric[at(h)] + fraction * mesh.barycentric[at(n)];
    glue(mesh, fresh + 1, mesh.twin[at(n)], mesh.rotation[at(n)]);
    copy_corner(mesh, at(fresh), at(n));
    glue(mesh, n, fresh + 2, 0);
    return fresh;
}

}  // namespace

int ChartedMesh::split_edge(int half_edge, double fraction) {
    const int w = vertex_count++;
    const int other = twin[at(half_edge)];
    const int turns = rotation[at(half_edge)];
    index.push_back(0);
    is_boundary.push_back(static_cast<char>(other < 0));
    const int far = halve_triangle(*this, half_edge, fraction, w);
    if (other < 0) {
        twin[at(far)] = -1;
        return w;
    }
    const int far_other = halve_triangle(*this, other, 1 - fraction, w);
    glue(*this, half_edge, far_other, turns);
    glue(*this, far, other, turns);
    return w;
}

std::vector<int> ChartedMesh::first_half_edges() const {
    std::vector<int> first(at(vertex_count), -1);
    for (std::size_t h = 0; h < origin.size(); ++h) {
        const auto rank = [&](std::size_t e) { return twin[e] < 0 ? 2 : is_line[e] ? 1 : 0; };
        int& chosen = first[at(origin[h])];
        if (chosen < 0 || rank(h) > rank(at(chosen))) chosen = static_cast<int>(h);
    }
    return first;
}

Triangles ChartedMesh::triangles() const {
    Triangles F(triangle_count(), 3);
    for (std::size_t h = 0; h < origin.size(); ++h) F.data()[h] = origin[h];
    return F;
}

ChartedMesh build_charts(const Topology& topology, const IntrinsicMetric& metric,
                         const CrossField& field, double edge_length,
                         const std::vector<int>& line_edges,
                         const std::vector<int>& feature_edges) {
    ChartedMesh mesh;
    const std::size_t corners = topology.origin.size();
    mesh.vertex_count = topology.vertex_count;
    mesh.origin = topology.origin;
    mesh.twin = topology.twin;
    mesh.rotation.assign(corners, 0);
    mesh.target.resize(corners);
    mesh.barycentric.resize(corners);
    mesh.is_line.assign(corners, 0);
    const auto mark = [&](const std::vector<int>& edges, char kind) {
        for (const int e : edges) {
            const int h = topology.edge_half_edge[at(e)];
            const int other = topology.twin[at(h)];
            if (other >= 0) mesh.is_line[at(h)] = mesh.is_line[at(other)] = kind;
        }
    };
    mark(feature_edges, ChartedMesh::feature_line);
    mark(line_edges, 1);
    mesh.parent.resize(at(topology.triangle_count));
    mesh.index.assign(field.index.data(), field.index.data() + field.index.size());
    mesh.is_boundary.resize(at(topology.vertex_count));
    for (int v = 0; v < topology.vertex_count; ++v) {
        mesh.is_boundary[at(v)] = topology.is_boundary_vertex(v) ? 1 : 0;
    }
    for (int t = 0; t < topology.triangle_count; ++t) {
        mesh.parent[at(t)] = t;
        const auto layout = lay_out_triangle(side_lengths(topology, metric, t));
        const Complex to_chart = std::polar(1 / edge_length, -field.angle[t]);
        for (int k = 0; k < 3; ++k) {
            mesh.target[at(3 * t + k)] = to_chart * Complex(layout(0, k), layout(1, k));
            mesh.barycentric[at(3 * t + k)] = Vector3::Unit(k);
        }
    }
    for (std::size_t h = 0; h < corners; ++h) {
        if (topology.twin[h] < 0) continue;
        const int edge = topology.edge[h];
        const bool is_lower = topology.edge_half_edge[at(edge)] == static_cast<int>(h);
        const int jump = field.period_jump[edge];
        mesh.rotation[h] = (is_lower ? -jump : jump) & 3;
    }
    return mesh;
}

int separate_singularities(ChartedMesh& mesh) {
    int splits = 0;
    for (std::size_t h = 0; h < mesh.origin.size(); ++h) {
        const int a = mesh.origin[h];
        const int b = mesh.origin[at(Topology::next(static_cast<int>(h)))];
        const bool between = mesh.index[at(a)] != 0 && mesh.index[at(b)] != 0;
        // An edge of a line stays whole: its two ends cannot drift apart sideways.
        if (!between || mesh.twin[h] < 0 || mesh.is_line[h]) continue;
        mesh.split_edge(static_cast<int>(h));
        ++splits;
    }
    return splits;
}

CutGraph cut_to_discs(ChartedMesh& mesh, const std::vector<char>& nodes) {
    const std::size_t corners = mesh.origin.size();
    const std::size_t triangles = corners / 3;
    CutGraph graph;
    graph.is_cut.assign(corners, 1);
    std::vector<int> turns(triangles, -1);
    std::vector<int> queue;
    queue.reserve(triangles);
    for (std::size_t seed = 0; seed < triangles; ++seed) {
        if (turns[seed] >= 0) continue;
        turns[seed] = 0;
        queue.assign(1, static_cast<int>(seed));
        for (std::size_t i = 0; i < queue.size(); ++i) {
            const int t = queue[i];
            for (int h = 3 * t; h < 3 * t + 3; ++h) {
                const int other = mesh.twin[at(h)];
                if (other < 0 || turns[at(other / 3)] >= 0) continue;
                turns[at(other / 3)] = (turns[at(t)] - mesh.rotation[at(h)]) & 3;
                graph.is_cut[at(h)] = graph.is_cut[at(other)] = 0;
                queue.push_back(other / 3);
            }
        }
    }
    for (std::size_t h = 0; h < corners; ++h) {
        mesh.target[h] = turn(mesh.target[h], turns[h / 3]);
        if (mesh.twin[h] < 0) {
            graph.is_cut[h] = 0;
        } else {
            mesh.rotation[h] = (mesh.rotation[h] + turns[at(mesh.twin[h] / 3)] - turns[h / 3]) & 3;
        }
    }

    std::vector<std::vector<int>> cut_at(at(mesh.vertex_count));
    std::vector<int> degree(at(mesh.vertex_count), 0);
    for (std::size_t h = 0; h < corners; ++h) {
        if (!graph.is_cut[h]) continue;
        cut_at[at(mesh.origin[h])].push_back(static_cast<int>(h));
        ++degree[at(mesh.origin[h])];
    }
    const auto is_loose = [&](int v) {
        return degree[at(v)] == 1 && mesh.index[at(v)] == 0 && !nodes[at(v)] &&
               !mesh.is_boundary[at(v)];
    };
    std::vector<int> loose;
    for (int v = 0; v < mesh.vertex_count; ++v) {
        if (is_loose(v)) loose.push_back(v);
    }
    while (!loose.empty()) {
        const int v = loose.back();
        loose.pop_back();
        if (!is_loose(v)) continue;
        for (const int h : cut_at[at(v)]) {
            if (!graph.is_cut[at(h)]) continue;
            const int end = mesh.origin[at(Topology::next(h))];
            graph.is_cut[at(h)] = graph.is_cut[at(mesh.twin[at(h)])] = 0;
            --degree[at(v)];
            --degree[at(end)];
            if (is_loose(end)) loose.push_back(end);
        }
    }
    return graph;
}

}  // namespace kinequad
