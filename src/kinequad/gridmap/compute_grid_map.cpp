#include "kinequad/gridmap/compute_grid_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "kinequad/core/error.h"
#include "kinequad/gridmap/quantize.h"
#include "kinequad/gridmap/refine_map.h"
#include "kinequad/gridmap/relax_map.h"
#include "kinequad/gridmap/seamless_map.h"

namespace kinequad {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr int most_rounds = 4;
constexpr int most_refinements = 12;
constexpr int relaxing_steps = 8;

double boundary_length(const Topology& topology, const IntrinsicMetric& metric) {
    double sum = 0;
    for (int e = 0; e < topology.edge_count; ++e) {
        if (topology.is_boundary_edge(e)) sum += metric.edge_length[e];
    }
    return sum;
}

/// The longest sides of `triangles` in the plane where their corners are `corners`. No two of the
/// sides belong to one triangle, so that all can be split one after the other.
std::vector<int> longest_sides(const ChartedMesh& mesh, const std::vector<Complex>& corners,
                               const std::vector<int>& triangles) {
    std::vector<int> chosen;
    std::vector<char> is_taken(mesh.parent.size(), 0);
    for (const int t : triangles) {
        int longest = 3 * t;
        for (int h = 3 * t; h < 3 * t + 3; ++h) {
            const auto length = [&](int e) {
                return std::abs(corners[at(Topology::next(e))] - corners[at(e)]);
            };
            if (length(h) > length(longest)) longest = h;
        }
        const int other = mesh.twin[at(longest)];
        if (is_taken[at(t)] || (other >= 0 && is_taken[at(other / 3)])) continue;
        is_taken[at(t)] = 1;
        if (other >= 0) is_taken[at(other / 3)] = 1;
        chosen.push_back(longest);
    }
    return chosen;
}

std::vector<int> reversed_triangles(const std::vector<TargetShape>& shapes,
                                    const std::vector<Complex>& corners) {
    std::vector<int> reversed;
    for (std::size_t t = 0; t < shapes.size(); ++t) {
        if (!keeps_direction(shapes[t], &corners[3 * t])) reversed.push_back(static_cast<int>(t));
    }
    return reversed;
}

/// Turns the real coordinates of a map whose integers are reached into exact fixed-point numbers.
GridMap fix_coordinates(const ChartedMesh& mesh, const MapVariables& variables,
                        const std::vector<Complex>& corners) {
    GridMap map;
    map.mesh.F = mesh.triangles();
    map.mesh.vertex_count = mesh.vertex_count;
    map.mesh.parent = mesh.parent;
    map.mesh.barycentric.resize(static_cast<Eigen::Index>(mesh.origin.size()), 3);
    map.topology = build_topology(map.mesh.F, mesh.vertex_count);
    map.corner.resize(mesh.origin.size());
    map.transition.resize(mesh.origin.size());
    map.index = Eigen::Map<const Eigen::VectorXi>(mesh.index.data(),
                                                  static_cast<Eigen::Index>(mesh.index.size()));

    const auto whole = [](double value) { return std::llround(value) * GridMap::one; };
    const auto fraction = [](double value) {
        return std::llround(std::ldexp(value, GridMap::fraction_bits));
    };
    for (std::size_t h = 0; h < mesh.origin.size(); ++h) {
        map.mesh.barycentric.row(static_cast<Eigen::Index>(h)) = mesh.barycentric[h].transpose();
        if (mesh.twin[h] < 0) continue;
        const Complex shift =
            corners[at(Topology::next(mesh.twin[h]))] - turn(corners[h], mesh.rotation[h]);
        map.transition[h] = {mesh.rotation[h], {whole(shift.real()), whole(shift.imag())}};
    }
    const std::vector<int> first = mesh.first_half_edges();
    for (int v = 0; v < mesh.vertex_count; ++v) {
        const int start = first[at(v)];
        if (start < 0) continue;
        const Complex z = corners[at(start)];
        GridMap::Coordinate here = {fraction(z.real()), fraction(z.imag())};
        if (variables.is_node[at(v)]) {
            here = {whole(z.real()), whole(z.imag())};
        } else if (mesh.is_boundary[at(v)]) {
            const Complex along = corners[at(Topology::next(start))] - z;
            (std::abs(along.real()) > std::abs(along.imag()) ? here.v : here.u) =
                std::abs(along.real()) > std::abs(along.imag()) ? whole(z.imag()) : whole(z.real());
        }
        for (int h = start; h >= 0;) {
            map.corner[at(h)] = here;
            const int in = Topology::previous(h);
            here = map.transition[at(in)](here);
            h = mesh.twin[at(in)];
            if (h == start) break;
        }
    }
    return map;
}

std::string describe(const GridMapReport& report) {
    return fmt::format(
        "{} flipped triangles, {} broken transitions, {} fractional translations, {} fractional "
        "singularities, {} wrong cone angles, {} unaligned boundary edges",
        report.flipped_triangles, report.broken_transitions, report.fractional_translations,
        report.fractional_singularities, report.wrong_cone_angles, report.unaligned_boundary_edges);
}

/// Brings the map to the integers, refining the mesh where its triangles hold the map back, and
/// relaxes it there. Nothing where refinement does not help.
std::optional<Eigen::VectorXd> reach_integers(ChartedMesh& mesh, MapVariables& variables,
                                              double scale, Eigen::VectorXd x,
                                              const Eigen::VectorXd& goal, const Context& context) {
    for (int round = 0; round < most_refinements; ++round) {
        TriangleSystem system(variables);
        const std::vector<TargetShape> shapes = target_shapes(mesh, scale);
        Arrival arrival = bring_to_integers(variables, system, shapes, x, goal, context);
        if (arrival.arrived)
            return relax_map(variables, system, shapes, arrival.x, relaxing_steps, context);
        const std::vector<int> sides =
            longest_sides(mesh, variables.corner_coordinates(arrival.x), arrival.tight);
        context.write_log(
            LogLevel::info,
            fmt::format("gridmap: {} triangles hold singularities back from the integer grid, "
                        "refining",
                        arrival.tight.size()));
        if (sides.empty()) return std::nullopt;
        x = refine_map(mesh, variables, std::move(arrival.x), sides);
    }
    return std::nullopt;
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
    const double quad_count = triangle_areas(topology, metric).sum() / (edge_length * edge_length);
    ChartedMesh mesh = build_charts(topology, metric, field, edge_length);
    separate_singularities(mesh);

    std::string obstacle;
    for (int round = 0; round < most_rounds; ++round) {
        context.report_progress("grid map", static_cast<double>(round) / most_rounds);
        const std::vector<char> nodes = find_nodes(mesh);
        const CutGraph cut = cut_to_discs(mesh, nodes);
        MapVariables variables = build_map_variables(mesh, cut, nodes);
        TriangleSystem system(variables);
        const std::vector<TargetShape> shapes = target_shapes(mesh, 1);
        context.write_log(LogLevel::debug,
                          fmt::format("gridmap: {} triangles, {} integer unknowns",
                                      mesh.triangle_count(), variables.integer_count()));
        const SeamlessMap seamless = solve_seamless_map(variables, system, shapes, context);
        const std::vector<Complex> corners = variables.corner_coordinates(seamless.x);
        if (seamless.reversed_triangles > 0) {
            obstacle = fmt::format("{} triangles stay reversed in the seamless map",
                                   seamless.reversed_triangles);
            context.write_log(LogLevel::info, "gridmap: " + obstacle);
            for (const int h :
                 longest_sides(mesh, mesh.target, reversed_triangles(shapes, corners))) {
                mesh.split_edge(h);
            }
            continue;
        }
        const ConeTriangulation cone(mesh, variables, corners, seamless.integers);
        const Quantization whole =
            quantize(cone, seamless.stiffness, seamless.best_integers, quad_count, context);
        context.write_log(LogLevel::debug, fmt::format("gridmap: {} quads at scale {:.4f}",
                                                       whole.quads, whole.scale));
        const Eigen::VectorXd goal = variables.lattice * whole.integers;
        std::optional<Eigen::VectorXd> x =
            reach_integers(mesh, variables, whole.scale, whole.scale * seamless.x, goal, context);
        if (!x) {
            obstacle = "singularities are held back from the integer grid";
            continue;
        }
        GridMap map = fix_coordinates(mesh, variables, variables.corner_coordinates(*x));
        const GridMapReport report = verify_grid_map(map);
        if (report.valid()) {
            context.report_progress("grid map", 1);
            return map;
        }
        obstacle = describe(report);
        context.write_log(LogLevel::info, "gridmap: " + obstacle);
    }
    throw GridMapError("no valid grid map at this density: " + obstacle +
                       "; ask for more vertices");
}

}  // namespace kinequad
