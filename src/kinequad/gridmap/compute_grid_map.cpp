#include "kinequad/gridmap/compute_grid_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kinequad/core/error.h"
#include "kinequad/gridmap/quantize.h"
#include "kinequad/gridmap/relax_map.h"
#include "kinequad/gridmap/seamless_map.h"

namespace kinequad {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr int most_refinements = 6;
constexpr int relaxing_steps = 8;

double boundary_length(const Topology& topology, const IntrinsicMetric& metric) {
    double sum = 0;
    for (int e = 0; e < topology.edge_count; ++e) {
        if (topology.is_boundary_edge(e)) sum += metric.edge_length[e];
    }
    return sum;
}

/// Cuts the longest side of each of `triangles` and every edge at the singular vertices among their corners.
void refine(ChartedMesh& mesh, const std::vector<int>& triangles) {
    std::vector<int> chosen;
    for (const int t : triangles) {
        int longest = 3 * t;
        for (int h = 3 * t; h < 3 * t + 3; ++h) {
            const auto length = [&](int e) {
                return std::abs(mesh.target[at(Topology::next(e))] - mesh.target[at(e)]);
            };
            if (length(h) > length(longest)) longest = h;
        }
        chosen.push_back(longest);
    }
    for (int& h : chosen) h = mesh.twin[at(h)] >= 0 ? std::min(h, mesh.twin[at(h)]) : h;
    std::sort(chosen.begin(), chosen.end());
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    for (const int h : chosen) mesh.split_edge(h);
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
    map.index = Eigen::Map<const Eigen::VectorXi>(mesh.index.data(), static_cast<Eigen::Index>(mesh.index.size()));

    const auto whole = [](double value) { return std::llround(value) * GridMap::one; };
    const auto fraction = [](double value) {
        return std::llround(std::ldexp(value, GridMap::fraction_bits));
    };
    for (std::size_t h = 0; h < mesh.origin.size(); ++h) {
        map.mesh.barycentric.row(static_cast<Eigen::Index>(h)) = mesh.barycentric[h].transpose();
        if (mesh.twin[h] < 0) continue;
        const Complex shift = corners[at(Topology::next(mesh.twin[h]))] - turn(corners[h], mesh.rotation[h]);
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

}  // namespace

double edge_length_for(const Topology& topology, const IntrinsicMetric& metric, int vertex_count) {
    // V = chi + Q + B / 2 for Q quads with B boundary edges; Q h^2 is the area, B h the boundary.
    const double area = triangle_areas(topology, metric).sum();
    const double interior = std::max(1, vertex_count - count_surface(topology).euler_characteristic);
    const double half_boundary = boundary_length(topology, metric) / 2;
    return (half_boundary + std::sqrt(half_boundary * half_boundary + 4 * interior * area)) / (2 * interior);
}

GridMap compute_grid_map(const Topology& topology, const IntrinsicMetric& metric, const CrossField& field,
                         const GridMapOptions& options, const Context& context) {
    const double edge_length = options.edge_length > 0
                                   ? options.edge_length
                                   : edge_length_for(topology, metric, options.vertex_count);
    const double quad_count = triangle_areas(topology, metric).sum() / (edge_length * edge_length);
    ChartedMesh mesh = build_charts(topology, metric, field, edge_length);
    separate_singularities(mesh);

    std::string obstacle;
    for (int round = 0; round < most_refinements; ++round) {
        context.report_progress("grid map", static_cast<double>(round) / most_refinements);
        const std::vector<char> nodes = find_nodes(mesh);
        const CutGraph cut = cut_to_discs(mesh, nodes);
        const MapVariables variables = build_map_variables(mesh, cut, nodes);
        TriangleSystem system(variables);
        std::vector<TargetShape> shapes = target_shapes(mesh, 1);
        context.write_log(LogLevel::debug,
                          fmt::format("gridmap: {} triangles, {} integer unknowns", mesh.triangle_count(),
                                      variables.integer_count()));
        const SeamlessMap seamless = solve_seamless_map(variables, system, shapes, context);
        if (seamless.reversed_triangles > 0) {
            obstacle = fmt::format("{} triangles stay reversed in the seamless map", seamless.reversed_triangles);
            context.write_log(LogLevel::info, "gridmap: " + obstacle);
            const std::vector<Complex> corners = variables.corner_coordinates(seamless.x);
            std::vector<int> reversed;
            for (std::size_t t = 0; t < shapes.size(); ++t) {
                if (count_reversed({shapes[t]}, {corners[3 * t], corners[3 * t + 1], corners[3 * t + 2]}) > 0) {
                    reversed.push_back(static_cast<int>(t));
                }
            }
            refine(mesh, reversed);
            continue;
        }
        context.report_progress("grid map", (round + 0.3) / most_refinements);
        const ConeTriangulation cone(mesh, variables, variables.corner_coordinates(seamless.x),
                                     seamless.integers);
        const Quantization whole =
            quantize(cone, seamless.stiffness, seamless.best_integers, quad_count, context);
        context.write_log(LogLevel::debug, fmt::format("gridmap: {} quads at scale {:.4f}", whole.quads, whole.scale));
        context.report_progress("grid map", (round + 0.5) / most_refinements);

        shapes = target_shapes(mesh, whole.scale);
        const Arrival arrival =
            bring_to_integers(variables, system, shapes, whole.scale * seamless.x,
                              variables.lattice * whole.integers, context);
        if (!arrival.arrived) {
            obstacle = fmt::format("{} triangles hold singularities back from the integer grid", arrival.tight.size());
            context.write_log(LogLevel::info, "gridmap: " + obstacle);
            refine(mesh, arrival.tight);
            continue;
        }
        const Eigen::VectorXd x = relax_map(variables, system, shapes, arrival.x, relaxing_steps, context);
        GridMap map = fix_coordinates(mesh, variables, variables.corner_coordinates(x));
        const GridMapReport report = verify_grid_map(map);
        if (report.valid()) {
            context.report_progress("grid map", 1);
            return map;
        }
        obstacle = describe(report);
        context.write_log(LogLevel::info, "gridmap: " + obstacle);
    }
    throw GridMapError("no valid grid map at this density: " + obstacle + "; ask for more vertices");
}

}  // namespace kinequad
