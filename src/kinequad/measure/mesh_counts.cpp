#include "kinequad/measure/mesh_counts.h"

#include <algorithm>
#include <tuple>
#include <vector>

#include "kinequad/core/disjoint_sets.h"
#include "kinequad/core/index.h"
#include "kinequad/core/sort_unique.h"
#include "kinequad/measure/triangulation.h"

namespace kinequad {
namespace {

/// A side of a face: from the vertex of corner `corner` to that of corner `next`.
struct Side {
    int low;
    int high;
    int corner;
    int next;
    bool is_forward;
};

std::vector<Side> sorted_sides(const Polygons& faces) {
    std::vector<Side> sides;
    sides.reserve(faces.corners.size());
    for (int f = 0; f < faces.count(); ++f) {
        const int first = faces.offset[at(f)];
        for (int k = 0; k < degree_of(faces, f); ++k) {
            const int corner = first + k;
            const int next = first + (k + 1) % degree_of(faces, f);
            const int a = faces.corners[at(corner)];
            const int b = faces.corners[at(next)];
            sides.push_back({std::min(a, b), std::max(a, b), corner, next, a < b});
        }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tie(a.low, a.high, a.corner) < std::tie(b.low, b.high, b.corner);
    });
    return sides;
}

int count_duplicates(const Polygons& faces) {
    std::vector<std::vector<int>> keys;
    keys.reserve(at(faces.count()));
    for (int f = 0; f < faces.count(); ++f) {
        std::vector<int>& key = keys.emplace_back();
        for (int k = 0; k < degree_of(faces, f); ++k) key.push_back(vertex_of(faces, f, k));
        std::sort(key.begin(), key.end());
    }
    sort_unique(keys);
    return faces.count() - static_cast<int>(keys.size());
}

void count_faces(const Polygons& faces, MeshCounts& counts) {
    counts.faces = faces.count();
    for (int f = 0; f < faces.count(); ++f) {
        const int degree = degree_of(faces, f);
        ++(degree == 4 ? counts.quads : degree == 3 ? counts.triangles : counts.other_faces);
    }
    counts.duplicate_faces = count_duplicates(faces);
}

}  // namespace

MeshCounts count_mesh(const Polygons& faces, int vertex_count) {
    check_polygons(faces, vertex_count);
    MeshCounts counts;
    count_faces(faces, counts);

    const std::size_t n = at(vertex_count);
    std::vector<int> valence(n, 0);
    std::vector<bool> is_used(n, false);
    std::vector<bool> is_boundary(n, false);
    for (const int v : faces.corners) is_used[at(v)] = true;
    DisjointSets parts(n);
    DisjointSets boundary(n);
    DisjointSets fans(faces.corners.size());

    const std::vector<Side> sides = sorted_sides(faces);
    const auto corner_at = [&](const Side& side, int v) {
        return faces.corners[at(side.corner)] == v ? side.corner : side.next;
    };
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t end = i + 1;
        while (end < sides.size() && sides[end].low == sides[i].low &&
               sides[end].high == sides[i].high) {
            ++end;
        }
        const auto [low, high, corner, next, is_forward] = sides[i];
        ++counts.edges;
        ++valence[at(low)];
        ++valence[at(high)];
        parts.unite(low, high);
        if (end - i == 1) {
            ++counts.boundary_edges;
            is_boundary[at(low)] = is_boundary[at(high)] = true;
            boundary.unite(low, high);
        }
        if (end - i == 2 && is_forward == sides[i + 1].is_forward) ++counts.misoriented_edges;
        if (end - i > 2) ++counts.non_manifold_edges;
        for (std::size_t j = i + 1; j < end; ++j) {
            for (const int v : {low, high}) {
                fans.unite(corner_at(sides[j - 1], v), corner_at(sides[j], v));
            }
        }
        i = end;
    }

    std::vector<int> fan_count(n, 0);
    for (int c = 0; c < static_cast<int>(faces.corners.size()); ++c) {
        if (fans.find(c) == c) ++fan_count[at(faces.corners[at(c)])];
    }
    for (int v = 0; v < vertex_count; ++v) {
        if (!is_used[at(v)]) continue;
        ++counts.vertices;
        if (valence[at(v)] != (is_boundary[at(v)] ? 3 : 4)) ++counts.irregular_vertices;
        if (fan_count[at(v)] > 1) ++counts.non_manifold_vertices;
        if (parts.find(v) == v) ++counts.components;
        if (is_boundary[at(v)] && boundary.find(v) == v) ++counts.boundary_loops;
    }
    counts.euler_characteristic = counts.vertices - counts.edges + counts.faces;
    return counts;
}

}  // namespace kinequad
