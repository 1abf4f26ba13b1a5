#include "kinequad/gridmap/map_variables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/gridmap/corner_form.h"

namespace kinequad {
namespace {

using IntegerForm = LinearForm<long>;
using IntegerCorner = CornerForm<long>;

/// Where the coordinates of one corner come from: `i^turns z_v + translation`.
struct CornerFrame {
    int turns = 0;
    IntegerCorner translation;
};

class Builder {
public:
    Builder(const ChartedMesh& mesh, const CutGraph& cut, const std::vector<char>& nodes)
        : mesh_(mesh), cut_(cut), nodes_(nodes), first_(mesh.first_half_edges()) {}

    MapVariables build() {
        number_variables();
        walk_vertices();
        add_line_rows();
        add_gauge_rows();
        return assemble();
    }

private:
    /// Coordinate `k` (0 u, 1 v) of a vertex: a whole variable or a free column.
    struct VertexCoordinate {
        bool is_whole = false;
        int number = -1;
    };

    int new_whole(int real_priority, int integer_priority) {
        real_priority_.push_back(real_priority);
        integer_priority_.push_back(integer_priority);
        return whole_count_++;
    }

    void number_variables() {
        coordinate_.resize(at(mesh_.vertex_count));
        for (int v = 0; v < mesh_.vertex_count; ++v) {
            if (first_[at(v)] < 0) continue;
            for (int k = 0; k < 2; ++k) {
                VertexCoordinate& coordinate = coordinate_[at(v)][at(k)];
                const bool on_line = mesh_.is_boundary[at(v)] || mesh_.is_line[at(first_[at(v)])];
                coordinate.is_whole =
                    nodes_[at(v)] != 0 || (on_line && k == line_coordinate(first_[at(v)]));
                coordinate.number = !coordinate.is_whole ? vertex_columns_++
                                    : nodes_[at(v)] != 0 ? new_whole(1, 2)
                                                         : new_whole(0, 0);
            }
        }
        position_count_ = whole_count_;
        translation_.assign(mesh_.origin.size(), -1);
        for (std::size_t h = 0; h < mesh_.origin.size(); ++h) {
            if (!cut_.is_cut[h] || mesh_.twin[h] < static_cast<int>(h)) continue;
            translation_[h] = new_whole(2, 1);
            new_whole(2, 1);
        }
    }

    /// The coordinate that is constant along half-edge `h` of the boundary or a line, in its chart.
    int line_coordinate(int h) const {
        const Complex along = mesh_.target[at(Topology::next(h))] - mesh_.target[at(h)];
        return std::abs(along.real()) > std::abs(along.imag()) ? 1 : 0;
    }

    /// Carries a corner frame across half-edge `h`.
    CornerFrame across(const CornerFrame& frame, int h) const {
        if (!cut_.is_cut[at(h)]) return frame;
        const int other = mesh_.twin[at(h)];
        const int turns = mesh_.rotation[at(h)];
        CornerFrame result;
        result.turns = (frame.turns + turns) & 3;
        const int number = translation_[at(std::min(h, other))];
        const IntegerCorner shift = {{{number, 1}}, {{number + 1, 1}}};
        if (h < other) {
            result.translation = add(turned(frame.translation, turns), shift);
        } else {
            result.translation = turned(add(frame.translation, turned(shift, 2)), turns);
        }
        return result;
    }

    void walk_vertices() {
        frame_.resize(mesh_.origin.size());
        std::vector<IntegerForm> late_rows;
        for (int v = 0; v < mesh_.vertex_count; ++v) {
            const int start = first_[at(v)];
            if (start < 0) continue;
            CornerFrame frame;
            int crossings = 0;
            int h = start;
            do {
                frame_[at(h)] = frame;
                const int in = Topology::previous(h);
                const int next = mesh_.twin[at(in)];
                if (next >= 0) {
                    crossings += cut_.is_cut[at(in)];
                    frame = across(frame, in);
                }
                h = next;
            } while (h >= 0 && h != start);
            if (h < 0 || crossings == 0) continue;
            // Chains of the cut first: they merge many translations into one.
            const bool on_chain = nodes_[at(v)] == 0 && crossings == 2;
            for (const IntegerForm& row : closing_rows(v, frame)) {
                (on_chain ? rows_ : late_rows).push_back(row);
            }
        }
        rows_.insert(rows_.end(), late_rows.begin(), late_rows.end());
    }

    /// `z = i^turns z + translation` after one turn around the vertex.
    std::array<IntegerForm, 2> closing_rows(int v, const CornerFrame& frame) const {
        IntegerCorner closing = frame.translation;
        if (nodes_[at(v)] != 0) {
            const IntegerCorner z = vertex_form(v);
            closing = add(closing, add(turned(z, frame.turns), turned(z, 2)));
        } else if (frame.turns != 0) {
            throw GridMapError(fmt::format(
                "vertex {} is regular but the cross field turns by {} quarters around it", v,
                frame.turns));
        }
        return {closing.u, closing.v};
    }

    /// The whole part of the coordinates of a vertex in its first chart.
    IntegerCorner vertex_form(int v) const {
        const auto form = [](VertexCoordinate c) {
            return c.is_whole ? IntegerForm{{c.number, 1}} : IntegerForm{};
        };
        return {form(coordinate_[at(v)][0]), form(coordinate_[at(v)][1])};
    }

    IntegerCorner corner_form(int h) const {
        const CornerFrame& frame = frame_[at(h)];
        return add(turned(vertex_form(mesh_.origin[at(h)]), frame.turns), frame.translation);
    }

    void add_line_rows() {
        for (int h = 0; h < static_cast<int>(mesh_.origin.size()); ++h) {
            const bool on_boundary = mesh_.twin[at(h)] < 0;
            const bool on_line = mesh_.is_line[at(h)] && h < mesh_.twin[at(h)];
            if (!on_boundary && !on_line) continue;
            const int end = Topology::next(h);
            const int k = line_coordinate(h);
            for (const int corner : {h, end}) {
                const int v = mesh_.origin[at(corner)];
                if (coordinate_[at(v)][at((k + frame_[at(corner)].turns) & 1)].is_whole) continue;
                throw GridMapError(
                    fmt::format("the cross field is not aligned with the {} at vertex {}",
                                on_boundary ? "boundary" : "line", v));
            }
            const IntegerCorner difference = add(corner_form(end), turned(corner_form(h), 2));
            rows_.push_back(k == 0 ? difference.u : difference.v);
        }
    }

    /// A map may be shifted as a whole: the first node of every component lies at the origin.
    void add_gauge_rows() {
        std::vector<char> seen(mesh_.parent.size(), 0);
        std::vector<int> stack;
        for (std::size_t seed = 0; seed < seen.size(); ++seed) {
            if (seen[seed]) continue;
            int root = -1;
            seen[seed] = 1;
            stack.push_back(static_cast<int>(seed));
            while (!stack.empty()) {
                const int t = stack.back();
                stack.pop_back();
                for (int h = 3 * t; h < 3 * t + 3; ++h) {
                    const int v = mesh_.origin[at(h)];
                    if (nodes_[at(v)] != 0 && (root < 0 || v < root)) root = v;
                    const int other = mesh_.twin[at(h)];
                    if (other < 0 || seen[at(other / 3)]) continue;
                    seen[at(other / 3)] = 1;
                    stack.push_back(other / 3);
                }
            }
            rows_.push_back({{coordinate_[at(root)][0].number, 1}});
            rows_.push_back({{coordinate_[at(root)][1].number, 1}});
        }
    }

    MapVariables assemble() const {
        std::vector<LinearForm<double>> real_rows;
        real_rows.reserve(rows_.size());
        for (const IntegerForm& row : rows_) real_rows.emplace_back(row.begin(), row.end());
        const Elimination<double> reals = eliminate_reals(whole_count_, real_rows, real_priority_);
        const Elimination<long> integers =
            eliminate_integers(whole_count_, rows_, integer_priority_);
        if (reals.free_count != integers.free_count) {
            throw GridMapError(
                fmt::format("the integer conditions have rank {} over the integers but {} "
                            "over the reals",
                            integers.free_count, reals.free_count));
        }

        MapVariables result;
        result.vertex_columns = vertex_columns_;
        result.chain_columns = reals.free_count;
        result.whole = reals.solution;
        result.position_count = position_count_;
        result.is_node = nodes_;
        result.lattice = Eigen::MatrixXd::Zero(reals.free_count, integers.free_count);
        for (int i = 0; i < reals.free_count; ++i) {
            for (const auto& [y, c] : integers.solution[at(reals.free_variable[at(i)])]) {
                result.lattice(i, y) = static_cast<double>(c);
            }
        }
        result.row_start.push_back(0);
        result.integer_part.resize(2 * mesh_.origin.size());
        for (int h = 0; h < static_cast<int>(mesh_.origin.size()); ++h) {
            const IntegerCorner form = corner_form(h);
            for (int k = 0; k < 2; ++k)
                add_corner_row(result, h, k, k == 0 ? form.u : form.v, reals, integers);
        }
        return result;
    }

    void add_corner_row(MapVariables& result, int h, int k, const IntegerForm& whole_part,
                        const Elimination<double>& reals, const Elimination<long>& integers) const {
        const int v = mesh_.origin[at(h)];
        const int turns = frame_[at(h)].turns;
        const VertexCoordinate own = coordinate_[at(v)][at((k + turns) & 1)];
        if (!own.is_whole) {
            // u' = (u, -v, -u, v) and v' = (v, u, -v, -u) after 0, 1, 2, 3 quarter turns.
            const bool negative = k == 0 ? (turns == 1 || turns == 2) : turns >= 2;
            result.column.push_back(own.number);
            result.coefficient.push_back(negative ? -1 : 1);
        }
        LinearForm<double> chain;
        IntegerForm integer;
        for (const auto& [whole, c] : whole_part) {
            chain = add_scaled(chain, static_cast<double>(c), reals.solution[at(whole)]);
            integer = add_scaled(integer, c, integers.solution[at(whole)]);
        }
        for (const auto& [column, c] : chain) {
            result.column.push_back(vertex_columns_ + column);
            result.coefficient.push_back(c);
        }
        result.row_start.push_back(static_cast<int>(result.column.size()));
        result.integer_part[2 * at(h) + at(k)] = std::move(integer);
    }

    const ChartedMesh& mesh_;
    const CutGraph& cut_;
    const std::vector<char>& nodes_;
    std::vector<int> first_;
    std::vector<std::array<VertexCoordinate, 2>> coordinate_;
    std::vector<int> translation_;
    std::vector<CornerFrame> frame_;
    std::vector<IntegerForm> rows_;
    std::vector<int> real_priority_;
    std::vector<int> integer_priority_;
    int vertex_columns_ = 0;
    int whole_count_ = 0;
    int position_count_ = 0;
};

}  // namespace

std::vector<Complex> MapVariables::corner_coordinates(const Eigen::VectorXd& x) const {
    std::vector<Complex> corners(row_start.size() / 2);
    for (std::size_t c = 0; c < corners.size(); ++c) {
        std::array<double, 2> value{};
        for (std::size_t k = 0; k < 2; ++k) {
            for (int i = row_start[2 * c + k]; i < row_start[2 * c + k + 1]; ++i) {
                value[k] += coefficient[at(i)] * x[column[at(i)]];
            }
        }
        corners[c] = {value[0], value[1]};
    }
    return corners;
}

namespace {

/// Whether a line passes straight through vertex `v`: two half-edges of lines leave it, half a turn
/// of the cross field apart on both sides. `start` is one of them.
bool passes_straight(const ChartedMesh& mesh, int start) {
    const auto quarter = [&](int h) {
        const Complex along = mesh.target[at(Topology::next(h))] - mesh.target[at(h)];
        return static_cast<int>(std::lround(std::arg(along) / (std::numbers::pi / 2)));
    };
    int turns = 0;  // from the chart of `start` to the one here
    int others = 0;
    bool is_straight = false;
    for (int h = start;;) {
        const int in = Topology::previous(h);
        if (mesh.twin[at(in)] < 0) return false;
        turns += mesh.rotation[at(in)];
        h = mesh.twin[at(in)];
        if (h == start) break;
        if (!mesh.is_line[at(h)]) continue;
        ++others;
        is_straight = ((quarter(h) - turns - quarter(start)) & 3) == 2;
    }
    return others == 1 && is_straight;
}

/// Ends, corners and crossings of lines are nodes, and so is one vertex of every closed line
/// without any.
void find_line_nodes(const ChartedMesh& mesh, const std::vector<int>& first,
                     std::vector<char>& nodes) {
    for (int v = 0; v < mesh.vertex_count; ++v) {
        const int h = first[at(v)];
        if (h < 0) continue;
        if (mesh.twin[at(h)] < 0) {
            // On the boundary any line ends.
            for (int e = h; e >= 0; e = mesh.twin[at(Topology::previous(e))]) {
                if (mesh.is_line[at(e)]) nodes[at(v)] = 1;
            }
        } else if (mesh.is_line[at(h)] && !passes_straight(mesh, h)) {
            nodes[at(v)] = 1;
        }
    }
    std::vector<char> seen(at(mesh.vertex_count), 0);
    std::vector<std::vector<int>> along(at(mesh.vertex_count));
    for (std::size_t h = 0; h < mesh.origin.size(); ++h) {
        if (!mesh.is_line[h]) continue;
        along[at(mesh.origin[h])].push_back(mesh.origin[at(Topology::next(static_cast<int>(h)))]);
    }
    for (int seed = 0; seed < mesh.vertex_count; ++seed) {
        if (seen[at(seed)] || along[at(seed)].empty()) continue;
        bool has_node = false;
        std::vector<int> stack = {seed};
        seen[at(seed)] = 1;
        while (!stack.empty()) {
            const int v = stack.back();
            stack.pop_back();
            has_node = has_node || nodes[at(v)] != 0;
            for (const int w : along[at(v)]) {
                if (seen[at(w)]) continue;
                seen[at(w)] = 1;
                stack.push_back(w);
            }
        }
        if (!has_node) nodes[at(seed)] = 1;
    }
}

}  // namespace

std::vector<char> find_nodes(const ChartedMesh& mesh) {
    std::vector<char> nodes(at(mesh.vertex_count), 0);
    for (int v = 0; v < mesh.vertex_count; ++v) nodes[at(v)] = mesh.index[at(v)] != 0 ? 1 : 0;

    // One vertex on every boundary loop without a corner.
    const std::vector<int> first = mesh.first_half_edges();
    std::vector<char> seen(mesh.origin.size(), 0);
    for (std::size_t start = 0; start < mesh.origin.size(); ++start) {
        if (mesh.twin[start] >= 0 || seen[start]) continue;
        bool has_node = false;
        for (auto h = static_cast<int>(start); !seen[at(h)];) {
            seen[at(h)] = 1;
            const int end = mesh.origin[at(Topology::next(h))];
            has_node = has_node || nodes[at(end)] != 0;
            h = first[at(end)];
        }
        if (!has_node) nodes[at(mesh.origin[start])] = 1;
    }

    find_line_nodes(mesh, first, nodes);

    // One vertex on every component without any.
    std::vector<char> reached(mesh.parent.size(), 0);
    for (std::size_t seed = 0; seed < reached.size(); ++seed) {
        if (reached[seed]) continue;
        bool has_node = false;
        std::vector<int> stack = {static_cast<int>(seed)};
        reached[seed] = 1;
        while (!stack.empty()) {
            const int t = stack.back();
            stack.pop_back();
            for (int h = 3 * t; h < 3 * t + 3; ++h) {
                has_node = has_node || nodes[at(mesh.origin[at(h)])] != 0;
                const int other = mesh.twin[at(h)];
                if (other < 0 || reached[at(other / 3)]) continue;
                reached[at(other / 3)] = 1;
                stack.push_back(other / 3);
            }
        }
        if (!has_node) nodes[at(mesh.origin[3 * seed])] = 1;
    }
    return nodes;
}

MapVariables build_map_variables(const ChartedMesh& mesh, const CutGraph& cut,
                                 const std::vector<char>& nodes) {
    return Builder(mesh, cut, nodes).build();
}

}  // namespace kinequad
