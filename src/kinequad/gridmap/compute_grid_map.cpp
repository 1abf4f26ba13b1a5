#include "kinequad/gridmap/compute_grid_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kinequad/core/index.h"
#include "kinequad/core/sort_unique.h"
#include "kinequad/gridmap/map_component.h"
#include "kinequad/gridmap/map_components.h"

namespace kinequad {
namespace {

/// Share of its quads that a part keeps at least where smaller parts took more than theirs.
constexpr double least_share = 0.7;
/// Share of all quads by which a part may miss its number.
constexpr double tolerance = 0.01;

double boundary_length(const Topology& topology, const IntrinsicMetric& metric) {
    double sum = 0;
    for (int e = 0; e < topology.edge_count; ++e) {
        if (topology.is_boundary_edge(e)) sum += metric.edge_length[e];
    }
    return sum;
}

/// Number of quads of a map: its area in cells.
double count_quads(const GridMap& map) {
    double area = 0;
    for (std::size_t h = 0; h < map.corner.size(); h += 3) {
        const auto cells = [](std::int64_t units) {
            return std::ldexp(static_cast<double>(units), -GridMap::fraction_bits);
        };
        const double au = cells(map.corner[h + 1].u - map.corner[h].u);
        const double av = cells(map.corner[h + 1].v - map.corner[h].v);
        const double bu = cells(map.corner[h + 2].u - map.corner[h].u);
        const double bv = cells(map.corner[h + 2].v - map.corner[h].v);
        area += (au * bv - av * bu) / 2;
    }
    return area;
}

/// Edges of the surface that is mapped with a feature line of its map on them.
std::vector<int> features_on_lines(const GridMap& map, const Topology& topology) {
    std::vector<int> edges;
    for (std::size_t h = 0; h < map.is_line.size(); ++h) {
        if (map.is_line[h] != ChartedMesh::feature_line) continue;
        const int side = side_of_parent(map.mesh, static_cast<int>(h));
        if (side >= 0) edges.push_back(topology.edge[at(side)]);
    }
    sort_unique(edges);
    return edges;
}

/// Number of `lines`, edges of the surface that is mapped, that are not all on lines of its map.
int count_lost(const std::vector<int>& lines, const GridMap& map, const Topology& topology) {
    std::vector<char> is_lost(at(topology.edge_count), 0);
    for (std::size_t h = 0; h < map.is_line.size(); ++h) {
        const int side = side_of_parent(map.mesh, static_cast<int>(h));
        if (side >= 0 && map.is_line[h] == 0) is_lost[at(topology.edge[at(side)])] = 1;
    }
    return static_cast<int>(std::count_if(lines.begin(), lines.end(), [&](int e) {
        const bool is_inside = topology.twin[at(topology.edge_half_edge[at(e)])] >= 0;
        return is_inside && is_lost[at(e)] != 0;
    }));
}

}  // namespace

double edge_length_for(const Topology& topology, const IntrinsicMetric& metric, int vertex_count) {
    // V = chi + Q + B / 2 for Q quads with B boundary edges; Q h^2 is the area, B h the boundary.
    const double area = triangle_areas(topology, metric).sum();
    const double interior =
        std::max(1, vertex_count - count_surface(topology).euler_characteristic);
    const double half_boundary = boundary_length(topology, metric) / 2;
    return (half_boundary + std::sqrt(half_boundary * half_boundary + 4 * interior * area)) /
           (2 * interior);
}

GridMap compute_grid_map(const Topology& topology, const IntrinsicMetric& metric,
                         const CrossField& field, const GridMapOptions& options,
                         const Context& context) {
    const double edge_length = options.edge_length > 0
                                   ? options.edge_length
                                   : edge_length_for(topology, metric, options.vertex_count);
    const ChartedMesh mesh = build_charts(topology, metric, field, edge_length, options.line_edges,
                                          options.feature_edges);
    const std::vector<MapComponent> components = split_components(mesh);
    std::vector<std::size_t> order(components.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return components[a].area < components[b].area;
    });
    double wanted_left = 0;
    for (const MapComponent& component : components) wanted_left += component.area;
    double area_left = wanted_left;
    const double wanted = wanted_left;
    std::vector<GridMap> maps(components.size());
    double made = 0;
    // The smallest parts come first: what they take more than their share, larger ones give.
    for (std::size_t i = 0; i < order.size(); ++i) {
        const MapComponent& component = components[order[i]];
        context.report_progress("grid map", (wanted - area_left) / wanted);
        const double share = std::max(least_share, wanted_left / area_left) * component.area;
        GridMap& map = maps[order[i]];
        map = map_component(component.mesh,
                            {std::min(share, 1.1 * component.area), tolerance * wanted}, context);
        const double quads = count_quads(map);
        made += quads;
        wanted_left -= quads;
        area_left -= component.area;
    }
    GridMap whole = join_maps(components, maps, topology.vertex_count);
    whole.feature_edges = features_on_lines(whole, topology);
    whole.lost_line_edges = count_lost(options.line_edges, whole, topology);
    whole.wanted_quads = wanted;
    whole.quads = made;
    context.report_progress("grid map", 1);
    return whole;
}

}  // namespace kinequad
