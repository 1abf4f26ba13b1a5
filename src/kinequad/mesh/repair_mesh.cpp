#include "kinequad/mesh/repair_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "kinequad/core/index.h"
#include "kinequad/core/sort_unique.h"
#include "kinequad/mesh/check_mesh.h"
#include "kinequad/mesh/edge_fans.h"

namespace kinequad {
namespace {

class Repair {
public:
    Repair(const Triangles& F, int vertex_count, const MeshDegeneracies& degeneracies)
        : F_(F), vertex_count_(vertex_count), source_(at(static_cast<int>(F.rows()))) {
        std::iota(source_.begin(), source_.end(), 0);
        is_flat_ = degeneracies.is_flat;
        is_point_ = degeneracies.is_point;
        length_ = degeneracies.length;
    }

    MeshRepair run() {
        report("passed over vertices without triangles", [&] {
            std::vector<char> is_used(at(vertex_count_), 0);
            for (Eigen::Index c = 0; c < F_.size(); ++c) is_used[at(F_.data()[c])] = 1;
            std::vector<int> unused;
            for (int v = 0; v < vertex_count_; ++v) {
                if (is_used[at(v)] == 0) unused.push_back(v);
            }
            return unused;
        }());
        drop("removed triangles that name a vertex twice", [&] {
            std::vector<int> collapsed;
            for (int t = 0; t < F_.rows(); ++t) {
                if (F_(t, 0) == F_(t, 1) || F_(t, 1) == F_(t, 2) || F_(t, 2) == F_(t, 0))
                    collapsed.push_back(t);
            }
            return collapsed;
        }());
        drop("removed triangles that repeat the vertices of another", [&] {
            std::vector<int> later;
            for (const auto& pair : find_duplicate_triangles(F_, all_triangles()))
                later.push_back(pair[1]);
            std::sort(later.begin(), later.end());
            return later;
        }());
        turn_triangles();
        copy_vertices();
        const bool is_manifold = [&] {
            const std::vector<EdgeFan> fans = find_edge_fans(F_, all_triangles());
            return std::none_of(fans.begin(), fans.end(), [&](const EdgeFan& fan) {
                return fan.half_edges.size() > 2 || fan.runs_one_way(F_);
            });
        }();
        if (is_manifold) {
            contract_points();
            flip_caps();
        }
        return {F_, copies_, actions_};
    }

private:
    std::vector<int> all_triangles() const {
        std::vector<int> all(at(static_cast<int>(F_.rows())));
        std::iota(all.begin(), all.end(), 0);
        return all;
    }

    void report(const char* action, std::vector<int> elements) {
        if (elements.empty()) return;
        std::sort(elements.begin(), elements.end());
        actions_.push_back(fmt::format("{}: {}", action, list_elements(elements)));
    }

    /// Removes triangles (ascending).
    void drop(const char* action, const std::vector<int>& dropped) {
        std::vector<int> sources;
        sources.reserve(dropped.size());
        for (const int t : dropped) sources.push_back(source_[at(t)]);
        report(action, sources);
        std::size_t skipped = 0;
        int kept = 0;
        for (int t = 0; t < F_.rows(); ++t) {
            if (skipped < dropped.size() && dropped[skipped] == t) {
                ++skipped;
                continue;
            }
            F_.row(kept) = F_.row(t).eval();
            source_[at(kept)] = source_[at(t)];
            is_flat_[at(kept)] = is_flat_[at(t)];
            for (int k = 0; k < 3; ++k) {
                is_point_[at(3 * kept + k)] = is_point_[at(3 * t + k)];
                length_[at(3 * kept + k)] = length_[at(3 * t + k)];
            }
            ++kept;
        }
        F_.conservativeResize(kept, 3);
        source_.resize(at(kept));
        is_flat_.resize(at(kept));
        is_point_.resize(at(3 * kept));
        length_.resize(at(3 * kept));
    }

    void turn_triangles() {
        const PartOrientation orientation = orient_parts(F_, all_triangles());
        std::vector<int> turned;
        for (int t = 0; t < F_.rows(); ++t) {
            if (orientation.is_turned[at(t)] == 0) continue;
            // (a, b, c) -> (a, c, b): half-edges 0 and 2 change places, 1 stays.
            std::swap(F_(t, 1), F_(t, 2));
            std::swap(is_point_[at(3 * t)], is_point_[at(3 * t + 2)]);
            std::swap(length_[at(3 * t)], length_[at(3 * t + 2)]);
            turned.push_back(source_[at(t)]);
        }
        report("turned triangles over", turned);
    }

    void copy_vertices() {
        const FanCorners corners = group_corners(F_, all_triangles());
        std::vector<char> has_fan(at(vertex_count_), 0);
        std::vector<int> name(corners.fan.size(), -1);
        std::vector<int> copied;
        for (int h = 0; h < static_cast<int>(corners.fan.size()); ++h) {
            if (corners.fan[at(h)] != h) continue;
            const int v = F_.data()[h];
            name[at(h)] = v;
            if (has_fan[at(v)] != 0) {
                name[at(h)] = vertex_count_ + static_cast<int>(copies_.size());
                copies_.push_back(v);
                copied.push_back(v);
            }
            has_fan[at(v)] = 1;
        }
        for (int h = 0; h < static_cast<int>(corners.fan.size()); ++h) {
            F_.data()[h] = name[at(corners.fan[at(h)])];
        }
        report("copied vertices whose triangles formed several fans", copied);
    }

    // What follows works on a manifold, with the triangles around every vertex.

    void link() {
        around_.assign(at(vertex_count_ + static_cast<int>(copies_.size())), {});
        for (int t = 0; t < F_.rows(); ++t) {
            for (int k = 0; k < 3; ++k) around_[at(F_(t, k))].push_back(t);
        }
        is_gone_.assign(at(static_cast<int>(F_.rows())), 0);
    }

    void drop_gone(const char* action) {
        std::vector<int> gone;
        for (int t = 0; t < F_.rows(); ++t) {
            if (is_gone_[at(t)] != 0) gone.push_back(t);
        }
        drop(action, gone);
    }

    /// Neighbours of vertex `v`, ascending, each once.
    std::vector<int> ring(int v) const {
        std::vector<int> neighbours;
        for (const int t : around_[at(v)]) {
            for (int k = 0; k < 3; ++k) {
                if (F_(t, k) != v) neighbours.push_back(F_(t, k));
            }
        }
        sort_unique(neighbours);
        return neighbours;
    }

    bool is_boundary(int v) const { return ring(v).size() != around_[at(v)].size(); }

    std::vector<int> triangles_of_edge(int a, int b) const {
        std::vector<int> found;
        for (const int t : around_[at(a)]) {
            if ((F_.row(t).array() == b).any()) found.push_back(t);
        }
        return found;
    }

    /// Contracts edges without length: both ends are one point in every frame.
    void contract_points() {
        link();
        std::vector<int> merged;
        for (int h = 0; h < F_.size(); ++h) {
            if (is_point_[at(h)] == 0 || is_gone_[at(h / 3)] != 0) continue;
            const int a = F_.data()[h];
            const int b = F_(h / 3, (h + 1) % 3);
            const std::vector<int> sides = triangles_of_edge(a, b);
            const std::vector<int> ring_a = ring(a);
            const std::vector<int> ring_b = ring(b);
            std::vector<int> common;
            std::set_intersection(ring_a.begin(), ring_a.end(), ring_b.begin(), ring_b.end(),
                                  std::back_inserter(common));
            // The link condition: else the surface would be pinched.
            const std::size_t fewest = sides.size() == 2 ? 6 : 2;
            const bool is_pinch = common.size() != sides.size() ||
                                  (sides.size() == 2 && is_boundary(a) && is_boundary(b)) ||
                                  around_[at(a)].size() + around_[at(b)].size() <= fewest;
            if (is_pinch) continue;
            for (const int t : sides) remove(t);
            for (const int t : around_[at(b)]) {
                for (int k = 0; k < 3; ++k) {
                    if (F_(t, k) == b) F_(t, k) = a;
                }
                around_[at(a)].push_back(t);
            }
            around_[at(b)].clear();
            merged.push_back(b);
        }
        drop_gone("removed triangles beside edges without length");
        report("joined vertices with a neighbour at the same place", merged);
    }

    void remove(int t) {
        is_gone_[at(t)] = 1;
        for (int k = 0; k < 3; ++k) {
            std::vector<int>& list = around_[at(F_(t, k))];
            list.erase(std::remove(list.begin(), list.end(), t), list.end());
        }
    }

    /// Flips the longest side of triangles without area: the neighbour across it takes the vertex
    /// that lies on it.
    void flip_caps() {
        link();
        std::vector<int> flipped;
        for (bool changed = true; changed;) {
            changed = false;
            for (int t = 0; t < F_.rows(); ++t) {
                if (is_flat_[at(t)] == 0 || is_gone_[at(t)] != 0) continue;
                if (!flip_cap(t)) continue;
                flipped.push_back(source_[at(t)]);
                changed = true;
            }
        }
        drop_gone("removed triangles without area at the boundary");
        report("flipped the longest side of triangles without area", flipped);
    }

    bool flip_cap(int t) {
        int k = 0;
        for (int i = 1; i < 3; ++i) {
            if (length_[at(3 * t + i)] > length_[at(3 * t + k)]) k = i;
        }
        const int a = F_(t, k);
        const int b = F_(t, (k + 1) % 3);
        const int c = F_(t, (k + 2) % 3);
        const double to_b = length_[at(3 * t + (k + 1) % 3)];
        const double to_a = length_[at(3 * t + (k + 2) % 3)];
        if (!(to_a > 0) || !(to_b > 0)) return false;
        const std::vector<int> sides = triangles_of_edge(a, b);
        if (sides.size() == 1) {
            if (is_boundary(c)) return false;
            remove(t);
            is_flat_[at(t)] = 0;
            return true;
        }
        const int other = sides[0] == t ? sides[1] : sides[0];
        if (is_flat_[at(other)] != 0) return false;
        int j = 0;
        while (F_(other, j) == a || F_(other, j) == b) ++j;
        const int d = F_(other, j);
        const std::vector<int> ring_c = ring(c);
        if (c == d || std::binary_search(ring_c.begin(), ring_c.end(), d)) return false;
        // other is (d, b, a) with half-edges d -> b, b -> a, a -> d; between c and d any length.
        const double db = length_[at(3 * other + j)];
        const double ad = length_[at(3 * other + (j + 2) % 3)];
        const auto put = [&](int triangle, std::array<int, 3> row, std::array<double, 3> lengths) {
            for (int i = 0; i < 3; ++i) {
                F_(triangle, i) = row[at(i)];
                length_[at(3 * triangle + i)] = lengths[at(i)];
                is_point_[at(3 * triangle + i)] = 0;
            }
            is_flat_[at(triangle)] = 0;
        };
        const double cd = std::max(db, ad);
        const auto leave = [&](int v, int triangle) {
            std::vector<int>& list = around_[at(v)];
            list.erase(std::remove(list.begin(), list.end(), triangle), list.end());
        };
        leave(b, t);
        leave(a, other);
        around_[at(d)].push_back(t);
        around_[at(c)].push_back(other);
        put(t, {c, a, d}, {to_a, ad, cd});
        put(other, {d, b, c}, {db, to_b, cd});
        return true;
    }

    Triangles F_;
    int vertex_count_;
    std::vector<int> source_;  ///< of every triangle, its number in the input
    std::vector<char> is_flat_;
    std::vector<char> is_point_;
    std::vector<double> length_;
    std::vector<int> copies_;
    std::vector<std::string> actions_;
    std::vector<std::vector<int>> around_;
    std::vector<char> is_gone_;
};

}  // namespace

MeshRepair repair_mesh(const Triangles& F, int vertex_count, const MeshDegeneracies& degeneracies) {
    const bool is_wild = F.size() > 0 && (F.minCoeff() < 0 || F.maxCoeff() >= vertex_count);
    if (is_wild) return {F, {}, {}};
    return Repair(F, vertex_count, degeneracies).run();
}

}  // namespace kinequad
