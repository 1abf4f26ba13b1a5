#include "kinequad/gridmap/map_component.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/gridmap/quantize.h"
#include "kinequad/gridmap/refine_map.h"
#include "kinequad/gridmap/relax_map.h"
#include "kinequad/gridmap/seamless_map.h"

namespace kinequad {
namespace {

/// Multiples of the wanted number of quads that are tried one after the other.
constexpr std::array<double, 6> densities = {1, 1.5, 2.5, 5, 12, 40};
constexpr int most_rounds = 3;
/// Bounds of the refinement where singularities are held back; no mesh gets more than twice as
/// fine.
constexpr int most_refinements = 12;
constexpr int relaxing_steps = 8;

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

/// `triangles`, then those that share a vertex with one of them.
std::vector<int> with_neighbours(const ChartedMesh& mesh, std::vector<int> triangles) {
    std::vector<char> is_near(at(mesh.vertex_count), 0);
    std::vector<char> is_listed(mesh.parent.size(), 0);
    for (const int t : triangles) {
        is_listed[at(t)] = 1;
        for (int h = 3 * t; h < 3 * t + 3; ++h) is_near[at(mesh.origin[at(h)])] = 1;
    }
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        if (is_listed[at(t)] != 0) continue;
        const bool touches = is_near[at(mesh.origin[at(3 * t)])] != 0 ||
                             is_near[at(mesh.origin[at(3 * t + 1)])] != 0 ||
                             is_near[at(mesh.origin[at(3 * t + 2)])] != 0;
        if (touches) triangles.push_back(t);
    }
    return triangles;
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
    map.is_line = mesh.is_line;
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
        } else if (mesh.is_boundary[at(v)] || mesh.is_line[at(start)]) {
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
        "singularities, {} wrong cone angles, {} unaligned edges",
        report.flipped_triangles, report.broken_transitions, report.fractional_translations,
        report.fractional_singularities, report.wrong_cone_angles, report.unaligned_edges);
}

/// Brings the map to the integers, refining the mesh where its triangles hold the map back, and
/// relaxes it there. Nothing where refinement does not help.
std::optional<Eigen::VectorXd> reach_integers(ChartedMesh& mesh, MapVariables& variables,
                                              double scale, Eigen::VectorXd x,
                                              const Eigen::VectorXd& goal, int most_triangles,
                                              const Context& context) {
    for (int round = 0; round < most_refinements && mesh.triangle_count() < most_triangles;
         ++round) {
        TriangleSystem system(variables);
        const std::vector<TargetShape> shapes = target_shapes(mesh, scale);
        Arrival arrival = bring_to_integers(variables, system, shapes, x, goal, context);
        if (arrival.arrived)
            return relax_map(variables, system, shapes, arrival.x, relaxing_steps, context);
        const std::vector<int> sides = longest_sides(mesh, variables.corner_coordinates(arrival.x),
                                                     with_neighbours(mesh, arrival.tight));
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

/// The map at one density, or what stands in the way.
struct Attempt {
    std::optional<GridMap> map;
    std::string obstacle;
    bool depends_on_density = true;
};

Attempt map_at_density(ChartedMesh mesh, const WantedQuads& wanted, const Context& context) {
    Attempt attempt;
    const int most_triangles = 2 * mesh.triangle_count() + 5000;
    for (int round = 0; round < most_rounds && mesh.triangle_count() < most_triangles; ++round) {
        context.check_cancelled();
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
            attempt.obstacle = fmt::format("{} triangles stay reversed in the seamless map",
                                           seamless.reversed_triangles);
            attempt.depends_on_density = false;
            context.write_log(LogLevel::info, "gridmap: " + attempt.obstacle);
            for (const int h :
                 longest_sides(mesh, mesh.target,
                               with_neighbours(mesh, reversed_triangles(shapes, corners)))) {
                mesh.split_edge(h);
            }
            continue;
        }
        attempt.depends_on_density = true;
        const ConeTriangulation cone(mesh, variables, corners, seamless.integers);
        const std::optional<Quantization> whole =
            quantize(cone, seamless.stiffness, seamless.best_integers, wanted, context);
        if (!whole) {
            attempt.obstacle = "the singularities find no room on the integer grid";
            return attempt;
        }
        context.write_log(LogLevel::debug, fmt::format("gridmap: {} quads at scale {:.4f}",
                                                       whole->quads, whole->scale));
        const Eigen::VectorXd goal = variables.lattice * whole->integers;
        std::optional<Eigen::VectorXd> x =
            reach_integers(mesh, variables, whole->scale, whole->scale * seamless.x, goal,
                           most_triangles, context);
        if (!x) {
            attempt.obstacle = "singularities are held back from the integer grid";
            continue;
        }
        GridMap map = fix_coordinates(mesh, variables, variables.corner_coordinates(*x));
        const GridMapReport report = verify_grid_map(map);
        if (report.valid()) {
            attempt.map = std::move(map);
            return attempt;
        }
        attempt.obstacle = describe(report);
        context.write_log(LogLevel::info, "gridmap: " + attempt.obstacle);
    }
    return attempt;
}

}  // namespace

GridMap map_component(ChartedMesh mesh, const WantedQuads& wanted, const Context& context) {
    // No part has fewer quads than a triangle.
    const double quad_count = std::max(wanted.count, 3.0);
    separate_singularities(mesh);
    std::string obstacle;
    for (const double factor : densities) {
        Attempt attempt = map_at_density(mesh, {factor * quad_count, wanted.tolerance}, context);
        if (attempt.map) return std::move(*attempt.map);
        obstacle = attempt.obstacle;
        if (!attempt.depends_on_density) break;
        context.write_log(LogLevel::info,
                          fmt::format("gridmap: not with {:.0f} quads on the part with triangle "
                                      "{} ({}); trying more",
                                      factor * quad_count, mesh.parent.front(), obstacle));
    }
    throw GridMapError(
        fmt::format("no valid grid map for the part with triangle {}: {}; ask for more vertices",
                    mesh.parent.front(), obstacle));
}

}  // namespace kinequad
