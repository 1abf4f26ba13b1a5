#include "kinequad/gridmap/map_components.h"

#include <algorithm>

#include "kinequad/core/index.h"

namespace kinequad {
namespace {

/// The part of every triangle, numbered in the order of their lowest triangles.
std::vector<int> number_parts(const ChartedMesh& mesh, int& count) {
    std::vector<int> part(mesh.parent.size(), -1);
    std::vector<int> stack;
    count = 0;
    for (int seed = 0; seed < mesh.triangle_count(); ++seed) {
        if (part[at(seed)] >= 0) continue;
        part[at(seed)] = count;
        stack.push_back(seed);
        while (!stack.empty()) {
            const int t = stack.back();
            stack.pop_back();
            for (int h = 3 * t; h < 3 * t + 3; ++h) {
                const int other = mesh.twin[at(h)];
                if (other < 0 || part[at(other / 3)] >= 0) continue;
                part[at(other / 3)] = count;
                stack.push_back(other / 3);
            }
        }
        ++count;
    }
    return part;
}

double area_of(const ChartedMesh& mesh, int t) {
    const Complex a = mesh.target[at(3 * t + 1)] - mesh.target[at(3 * t)];
    const Complex b = mesh.target[at(3 * t + 2)] - mesh.target[at(3 * t)];
    return std::imag(std::conj(a) * b) / 2;
}

}  // namespace

std::vector<MapComponent> split_components(const ChartedMesh& mesh) {
    int count = 0;
    const std::vector<int> part = number_parts(mesh, count);
    std::vector<MapComponent> components(at(count));
    std::vector<int> new_triangle(mesh.parent.size());
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        ChartedMesh& own = components[at(part[at(t)])].mesh;
        new_triangle[at(t)] = own.triangle_count();
        own.parent.push_back(mesh.parent[at(t)]);
    }
    std::vector<int> new_vertex(at(mesh.vertex_count), -1);
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        MapComponent& component = components[at(part[at(t)])];
        ChartedMesh& own = component.mesh;
        component.area += area_of(mesh, t);
        for (int h = 3 * t; h < 3 * t + 3; ++h) {
            const int v = mesh.origin[at(h)];
            if (new_vertex[at(v)] < 0) {
                new_vertex[at(v)] = own.vertex_count++;
                component.vertex.push_back(v);
                own.index.push_back(mesh.index[at(v)]);
                own.is_boundary.push_back(mesh.is_boundary[at(v)]);
            }
            const int other = mesh.twin[at(h)];
            own.origin.push_back(new_vertex[at(v)]);
            own.twin.push_back(other < 0 ? -1 : 3 * new_triangle[at(other / 3)] + other % 3);
            own.rotation.push_back(mesh.rotation[at(h)]);
            own.target.push_back(mesh.target[at(h)]);
            own.is_line.push_back(mesh.is_line[at(h)]);
            own.barycentric.push_back(mesh.barycentric[at(h)]);
        }
    }
    return components;
}

GridMap join_maps(const std::vector<MapComponent>& components, const std::vector<GridMap>& maps,
                  int vertex_count) {
    Eigen::Index triangles = 0;
    for (const GridMap& map : maps) triangles += map.mesh.F.rows();
    GridMap whole;
    whole.mesh.F.resize(triangles, 3);
    whole.mesh.barycentric.resize(3 * triangles, 3);
    whole.mesh.vertex_count = vertex_count;
    std::vector<int> index(at(vertex_count), 0);
    Eigen::Index done = 0;
    for (std::size_t i = 0; i < maps.size(); ++i) {
        const GridMap& map = maps[i];
        const auto old_count = static_cast<int>(components[i].vertex.size());
        std::vector<int> number(at(map.mesh.vertex_count));
        for (int v = 0; v < map.mesh.vertex_count; ++v) {
            number[at(v)] = v < old_count ? components[i].vertex[at(v)] : whole.mesh.vertex_count++;
        }
        index.resize(at(whole.mesh.vertex_count), 0);
        for (int v = 0; v < map.mesh.vertex_count; ++v) index[at(number[at(v)])] = map.index[v];
        const Eigen::Index rows = map.mesh.F.rows();
        for (Eigen::Index c = 0; c < 3 * rows; ++c) {
            whole.mesh.F.data()[3 * done + c] = number[at(map.mesh.F.data()[c])];
        }
        whole.mesh.barycentric.middleRows(3 * done, 3 * rows) = map.mesh.barycentric;
        whole.mesh.parent.insert(whole.mesh.parent.end(), map.mesh.parent.begin(),
                                 map.mesh.parent.end());
        whole.is_line.insert(whole.is_line.end(), map.is_line.begin(), map.is_line.end());
        whole.corner.insert(whole.corner.end(), map.corner.begin(), map.corner.end());
        whole.transition.insert(whole.transition.end(), map.transition.begin(),
                                map.transition.end());
        done += rows;
    }
    whole.topology = build_topology(whole.mesh.F, whole.mesh.vertex_count);
    whole.index =
        Eigen::Map<const Eigen::VectorXi>(index.data(), static_cast<Eigen::Index>(index.size()));
    return whole;
}

}  // namespace kinequad
