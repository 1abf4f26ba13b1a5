#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>

#include "kinequad/core/index.h"
#include "kinequad/core/sort_unique.h"
#include "kinequad/synth/half_mesh.h"

namespace kinequad::synth_detail {
namespace {

/// Thin parts count their edges as longer, up to this many times.
constexpr double most_refined = 2.2;
constexpr std::size_t most_neighbors = 8;

class Decimator {
public:
    Decimator(const HalfMesh& mesh, const ImplicitBody& body) : mesh_(mesh), body_(body) {
        alive_.assign(mesh.triangles.size(), 1);
        triangle_count_ = mesh.triangles.size();
        around_.resize(mesh.vertices.size());
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            for (const int v : mesh.triangles[t]) {
                around_[at(v)].push_back(static_cast<int>(t));
            }
        }
        for (const Vector3& point : mesh.vertices) {
            refinement_.push_back(
                std::clamp(0.075 / std::max(body.local_radius(point), 1e-3), 1.0, most_refined));
        }
        for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
            push_edges(static_cast<int>(v), true);
    }

    void run(std::size_t half_triangle_count, const Context& context) {
        while (triangle_count_ > half_triangle_count && !queue_.empty()) {
            context.check_cancelled();
            const auto [cost, a, b] = queue_.top();
            queue_.pop();
            if (around(a).empty() || around(b).empty() || cost != cost_of(a, b)) continue;
            collapse(a, b);
        }
    }

    HalfMesh result() const {
        HalfMesh kept;
        std::vector<int> number(mesh_.vertices.size(), -1);
        for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) {
            if (around_[v].empty()) continue;
            number[v] = static_cast<int>(kept.vertices.size());
            kept.vertices.push_back(mesh_.vertices[v]);
            kept.in_plane.push_back(mesh_.in_plane[v]);
        }
        for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
            if (alive_[t] == 0) continue;
            const auto [a, b, c] = mesh_.triangles[t];
            kept.triangles.push_back({number[at(a)], number[at(b)], number[at(c)]});
        }
        return kept;
    }

private:
    const Vector3& place(int v) const { return mesh_.vertices[at(v)]; }
    bool in_plane(int v) const { return mesh_.in_plane[at(v)] != 0; }
    std::vector<int>& around(int v) { return around_[at(v)]; }
    const std::array<int, 3>& corners(int t) const { return mesh_.triangles[at(t)]; }
    bool has(int t, int v) const {
        const auto& c = corners(t);
        return c[0] == v || c[1] == v || c[2] == v;
    }

    double cost_of(int a, int b) const {
        return (place(a) - place(b)).norm() * 0.5 * (refinement_[at(a)] + refinement_[at(b)]);
    }

    /// Neighbours of a vertex, ascending.
    std::vector<int> neighbors(int v) const {
        std::vector<int> found;
        for (const int t : around_[at(v)]) {
            for (const int w : corners(t)) {
                if (w != v) found.push_back(w);
            }
        }
        sort_unique(found);
        return found;
    }

    void push_edges(int v, bool upwards_only) {
        for (const int w : neighbors(v)) {
            if (upwards_only && w < v) continue;
            queue_.emplace(cost_of(std::min(v, w), std::max(v, w)), std::min(v, w), std::max(v, w));
        }
    }

    /// Whether the triangles around `v`, but for those that hold `other`, keep their side and do
    /// not become needles when `v` moves to `target`.
    bool stays_sound(int v, int other, const Vector3& target) {
        for (const int t : around(v)) {
            if (has(t, other)) continue;
            std::array<Vector3, 3> now;
            std::array<Vector3, 3> then;
            for (std::size_t k = 0; k < 3; ++k) {
                now[k] = place(corners(t)[k]);
                then[k] = corners(t)[k] == v ? target : now[k];
            }
            const Vector3 before = (now[1] - now[0]).cross(now[2] - now[0]);
            const Vector3 after = (then[1] - then[0]).cross(then[2] - then[0]);
            const double longest =
                std::max({(then[1] - then[0]).squaredNorm(), (then[2] - then[1]).squaredNorm(),
                          (then[0] - then[2]).squaredNorm()});
            if (after.dot(before) < 0.4 * after.norm() * before.norm()) return false;
            if (after.norm() < 0.12 * longest) return false;
        }
        return true;
    }

    /// Collapses `b` into `a`, or `a` into `b`, where the surface stays manifold and sound.
    void collapse(int a, int b) {
        if (in_plane(b) && !in_plane(a)) std::swap(a, b);
        // Now a is in the plane where either is.
        const auto near_a = neighbors(a);
        const auto near_b = neighbors(b);
        std::vector<int> common;
        std::set_intersection(near_a.begin(), near_a.end(), near_b.begin(), near_b.end(),
                              std::back_inserter(common));
        const bool both = in_plane(a) && in_plane(b);
        if (common.size() != (both ? 1U : 2U)) return;
        if (near_a.size() + near_b.size() - common.size() - 2 > most_neighbors) return;
        if (in_plane(a) && !in_plane(b)) {
            // No edge may join two vertices of the plane through the inside.
            for (const int w : near_b) {
                if (w != a && in_plane(w) && !std::binary_search(common.begin(), common.end(), w)) {
                    return;
                }
            }
        }
        Vector3 target = place(a);
        if (in_plane(a) == in_plane(b)) {
            const Vector3 middle = 0.5 * (place(a) + place(b));
            target =
                body_.project(middle, both, body_.select(middle, (place(a) - place(b)).norm()));
        }
        if (!both && !in_plane(a) && target.x() <= 0.25 * std::min(place(a).x(), place(b).x()))
            return;
        if (!stays_sound(a, b, target) || !stays_sound(b, a, target)) return;
        for (const int t : around(b)) {
            if (has(t, a)) {
                alive_[at(t)] = 0;
                --triangle_count_;
                for (const int v : corners(t)) {
                    if (v != b) std::erase(around(v), t);
                }
            } else {
                for (int& v : mesh_.triangles[at(t)]) {
                    if (v == b) v = a;
                }
                around(a).push_back(t);
            }
        }
        around(b).clear();
        mesh_.vertices[at(a)] = target;
        push_edges(a, false);
    }

    HalfMesh mesh_;
    const ImplicitBody& body_;
    std::vector<char> alive_;
    std::size_t triangle_count_ = 0;
    std::vector<std::vector<int>> around_;  ///< triangles of a vertex
    std::vector<double> refinement_;        ///< one a vertex
    using Entry = std::tuple<double, int, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

}  // namespace

HalfMesh decimate_half_mesh(const HalfMesh& mesh, const ImplicitBody& body, int triangle_count,
                            const Context& context) {
    Decimator decimator(mesh, body);
    decimator.run(static_cast<std::size_t>(triangle_count / 2), context);
    return decimator.result();
}

}  // namespace kinequad::synth_detail
