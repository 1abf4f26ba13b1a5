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
constexpr int straight_rounds = 4;
constexpr int winding_rounds = 5;
/// Counts, as shares of the wanted one, for which whole numbers are looked for until the map can be
/// brought to them: close by, others come out.
constexpr std::array<double, 5> counts_near = {1, 0.97, 1.03, 0.95, 1.05};
/// Length of the pieces that the path of the cones is followed in, in cells.
constexpr double longest_move = 0.2;
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

/// A map on its way to the integers, on a mesh that is refined where it holds the map back.
struct MovingMap {
    ChartedMesh mesh;
    MapVariables variables;
    Eigen::VectorXd x;
};

/// Moves `map` by `advance` until it arrives, and relaxes it there. Where it gets stuck the mesh is
/// refined, at most `most_rounds` times. Returns false where that does not help.
template <class Advance>
bool arrive(MovingMap& map, double scale, int most_rounds, int most_triangles,
            const Advance& advance, const Context& context) {
    for (int round = 0; round < most_rounds && map.mesh.triangle_count() < most_triangles;
         ++round) {
        TriangleSystem system(map.variables);
        const std::vector<TargetShape> shapes = target_shapes(map.mesh, scale);
        Arrival arrival = advance(map, system, shapes);
        if (arrival.arrived) {
            map.x = relax_map(map.variables, system, shapes, arrival.x, relaxing_steps, context);
            return true;
        }
        if (round + 1 == most_rounds) return false;
        const std::vector<int> sides =
            longest_sides(map.mesh, map.variables.corner_coordinates(arrival.x),
                          with_neighbours(map.mesh, arrival.tight));
        context.write_log(
            LogLevel::info,
            fmt::format("gridmap: {} triangles hold singularities back from the integer grid, "
                        "refining",
                        arrival.tight.size()));
        if (sides.empty()) return false;
        map.x = refine_map(map.mesh, map.variables, std::move(arrival.x), sides);
    }
    return false;
}

/// Brings the map to the integers the straight way. Nothing where it is blocked.
std::optional<MovingMap> go_straight(MovingMap map, const Quantization& whole, int most_triangles,
                                     const Context& context) {
    const Eigen::VectorXd goal = map.variables.lattice * whole.integers;
    const auto advance = [&](const MovingMap& here, TriangleSystem& system,
                             const std::vector<TargetShape>& shapes) {
        return bring_to_integers(here.variables, system, shapes, here.x, goal, context);
    };
    if (arrive(map, whole.scale, straight_rounds, most_triangles, advance, context)) return map;
    return std::nullopt;
}

/// Brings the map to the integers along the path that the cones took, which may lead around one
/// another. Nothing where that is too far.
std::optional<MovingMap> go_along_path(MovingMap map, const Quantization& whole, int most_triangles,
                                       const Context& context) {
    context.write_log(LogLevel::info, fmt::format("gridmap: following the path of the cones, {} "
                                                  "moves",
                                                  whole.path.size() - 1));
    std::vector<Eigen::VectorXd> path;
    for (const Eigen::VectorXd& y : whole.path) {
        const Eigen::VectorXd next = map.variables.lattice * y;
        if (!path.empty()) {
            const Eigen::VectorXd from = path.back();
            const auto pieces =
                static_cast<int>(std::ceil((next - from).cwiseAbs().maxCoeff() / longest_move));
            for (int i = 1; i < pieces; ++i) path.emplace_back(from + (next - from) * i / pieces);
        }
        path.push_back(next);
    }
    std::size_t reached = 0;
    const auto advance = [&](const MovingMap& here, TriangleSystem& system,
                             const std::vector<TargetShape>& shapes) {
        return follow_path(here.variables, system, shapes, here.x, path, reached, context);
    };
    if (arrive(map, whole.scale, winding_rounds, most_triangles, advance, context)) return map;
    return std::nullopt;
}

/// Looks for whole numbers that the map can be brought to, and brings it there. Nothing, and the
/// `obstacle`, where there are none.
std::optional<MovingMap> find_whole_map(const MovingMap& real, const ConeTriangulation& cone,
                                        const SeamlessMap& seamless, const WantedQuads& wanted,
                                        int most_triangles, std::string& obstacle,
                                        const Context& context) {
    const auto scaled = [&](double scale) {
        return MovingMap{real.mesh, real.variables, scale * real.x};
    };
    std::optional<Quantization> first;
    for (const double share : counts_near) {
        std::optional<Quantization> whole =
            quantize(cone, seamless.stiffness, seamless.best_integers,
                     {share * wanted.count, wanted.tolerance}, context);
        if (!whole) {
            obstacle = "the singularities find no room on the integer grid";
            break;
        }
        context.write_log(LogLevel::debug, fmt::format("gridmap: {} quads at scale {:.4f}",
                                                       whole->quads, whole->scale));
        std::optional<MovingMap> arrived =
            go_straight(scaled(whole->scale), *whole, most_triangles, context);
        if (arrived) return arrived;
        obstacle = "singularities are held back from the integer grid";
        if (!first) first = std::move(whole);
    }
    if (!first) return std::nullopt;
    return go_along_path(scaled(first->scale), *first, most_triangles, context);
}

bool has_lines(const ChartedMesh& mesh) {
    return std::any_of(mesh.is_line.begin(), mesh.is_line.end(), [](char c) { return c != 0; });
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
        std::optional<MapVariables> built;
        try {
            built = build_map_variables(mesh, cut, nodes);
        } catch (const GridMapError& error) {
            // Crosses do not follow all lines on a surface that is coarse for them.
            if (!has_lines(mesh)) throw GridMapError(error.what(), false);
            attempt.obstacle = error.what();
            attempt.depends_on_density = false;
            return attempt;
        }
        MapVariables& variables = *built;
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
            const std::vector<int> reversed = reversed_triangles(shapes, corners);
            if (const int lines = give_up_lines_at(mesh, reversed); lines > 0) {
                context.write_log(
                    LogLevel::info,
                    fmt::format("gridmap: {} feature edges there are no lines any more", lines));
                // This is no refinement, and ends when there are no features left.
                --round;
                continue;
            }
            for (const int h : longest_sides(mesh, mesh.target, with_neighbours(mesh, reversed))) {
                mesh.split_edge(h);
            }
            continue;
        }
        attempt.depends_on_density = true;
        const ConeTriangulation cone(mesh, variables, corners, seamless.integers);
        const MovingMap real{mesh, variables, seamless.x};
        const std::optional<MovingMap> arrived =
            find_whole_map(real, cone, seamless, wanted, most_triangles, attempt.obstacle, context);
        if (!arrived) return attempt;
        GridMap map = fix_coordinates(arrived->mesh, arrived->variables,
                                      arrived->variables.corner_coordinates(arrived->x));
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
    const auto has_features = [&] {
        return std::find(mesh.is_line.begin(), mesh.is_line.end(), ChartedMesh::feature_line) !=
               mesh.is_line.end();
    };
    if (has_features()) {
        const int narrow = give_up_narrow_lines(mesh);
        context.write_log(LogLevel::debug,
                          fmt::format("gridmap: {} feature edges are too near others", narrow));
        ChartedMesh with_lines = mesh;
        separate_singularities(with_lines);
        Attempt attempt =
            map_at_density(std::move(with_lines), {quad_count, wanted.tolerance}, context);
        if (attempt.map) return std::move(*attempt.map);
        context.write_log(LogLevel::info,
                          fmt::format("gridmap: not with the features of the part with triangle {} "
                                      "as lines ({}); crosses follow them still",
                                      mesh.parent.front(), attempt.obstacle));
        std::replace(mesh.is_line.begin(), mesh.is_line.end(), ChartedMesh::feature_line, '\0');
    }
    separate_singularities(mesh);
    const char* remedy = has_lines(mesh)
                             ? "refine the input there, or leave out features or symmetry"
                             : "refine the input there";
    std::string obstacle;
    bool depends_on_density = true;
    for (const double factor : densities) {
        Attempt attempt = map_at_density(mesh, {factor * quad_count, wanted.tolerance}, context);
        if (attempt.map) return std::move(*attempt.map);
        obstacle = attempt.obstacle;
        depends_on_density = attempt.depends_on_density;
        if (!depends_on_density) break;
        context.write_log(LogLevel::info,
                          fmt::format("gridmap: not with {:.0f} quads on the part with triangle "
                                      "{} ({}); trying more",
                                      factor * quad_count, mesh.parent.front(), obstacle));
    }
    const auto is_fixed_line = [](char line) {
        return line != 0 && line != ChartedMesh::feature_line;
    };
    if (std::any_of(mesh.is_line.begin(), mesh.is_line.end(), is_fixed_line)) {
        context.write_log(
            LogLevel::info,
            fmt::format("gridmap: not with the line of symmetry through the part "
                        "with triangle {} as a line ({}); giving up what is in the way",
                        mesh.parent.front(), obstacle));
        std::replace_if(mesh.is_line.begin(), mesh.is_line.end(), is_fixed_line,
                        ChartedMesh::feature_line);
        return map_component(std::move(mesh), wanted, context);
    }
    throw GridMapError(
        fmt::format("no valid grid map for the part with triangle {}: {}; {}", mesh.parent.front(),
                    obstacle, depends_on_density ? "ask for more vertices" : remedy),
        depends_on_density);
}

}  // namespace kinequad
