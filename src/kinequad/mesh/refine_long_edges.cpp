#include "kinequad/mesh/refine_long_edges.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <vector>

#include "kinequad/core/index.h"

namespace kinequad {
namespace {

/// Half-edges 3 t + k as in `Topology`, growing.
class Refinement {
public:
    Refinement(const Topology& topology, const IntrinsicMetric& metric,
               const RefineOptions& options)
        : most_triangles_(std::max(options.most_triangles, topology.triangle_count)),
          vertex_count_(topology.vertex_count),
          origin_(topology.origin),
          twin_(topology.twin),
          parent_(at(topology.triangle_count)),
          barycentric_(origin_.size()),
          place_(origin_.size()),
          length_(origin_.size()),
          limit_(limits(topology, metric, options)) {
        for (std::size_t h = 0; h < origin_.size(); ++h) {
            parent_[h / 3] = static_cast<int>(h / 3);
            barycentric_[h] = Vector3::Unit(static_cast<Eigen::Index>(h % 3));
            length_[h] = metric.edge_length[topology.edge[h]];
        }
        for (int t = 0; t < topology.triangle_count; ++t) {
            const auto corners = lay_out_triangle(side_lengths(topology, metric, t));
            for (int k = 0; k < 3; ++k) place_[at(3 * t + k)] = corners.col(k);
        }
        is_line_side_.assign(origin_.size(), 0);
        for (const int e : options.lines) {
            const int h = topology.edge_half_edge[at(e)];
            is_line_side_[at(h)] = 1;
            if (topology.twin[at(h)] >= 0) is_line_side_[at(topology.twin[at(h)])] = 1;
        }
        is_boundary_.resize(at(vertex_count_));
        for (int v = 0; v < vertex_count_; ++v) {
            is_boundary_[at(v)] = topology.is_boundary_vertex(v) ? 1 : 0;
        }
        for (const int e : options.lines) {
            const int h = topology.edge_half_edge[at(e)];
            is_boundary_[at(topology.origin[at(h)])] = is_boundary_[at(topology.target(h))] = 1;
        }
    }

    void run(const Context& context) {
        for (int h = 0; h < half_edge_count(); ++h) offer(h);
        int splits = 0;
        while (!queue_.empty() && half_edge_count() / 3 + 2 <= most_triangles_) {
            const Candidate candidate = queue_.top();
            queue_.pop();
            // Splits leave candidates behind whose edge has changed since.
            if (length_[at(candidate.half_edge)] != candidate.length ||
                !is_wanted(candidate.half_edge)) {
                continue;
            }
            split(candidate.half_edge);
            if (++splits % 4096 == 0) context.check_cancelled();
        }
    }

    RefinedMesh take() const {
        RefinedMesh mesh;
        mesh.vertex_count = vertex_count_;
        mesh.parent = parent_;
        mesh.F.resize(half_edge_count() / 3, 3);
        mesh.barycentric.resize(half_edge_count(), 3);
        for (int h = 0; h < half_edge_count(); ++h) {
            mesh.F.data()[h] = origin_[at(h)];
            mesh.barycentric.row(h) = barycentric_[at(h)].transpose();
        }
        return mesh;
    }

private:
    struct Candidate {
        double length;
        int half_edge;
        bool operator<(const Candidate& other) const {
            return length != other.length ? length < other.length : half_edge > other.half_edge;
        }
    };

    int half_edge_count() const { return static_cast<int>(origin_.size()); }

    /// Longest edge of each triangle's connected part: small parts get enough triangles by it.
    static std::vector<double> limits(const Topology& topology, const IntrinsicMetric& metric,
                                      const RefineOptions& options) {
        const std::vector<int> component = triangle_components(topology);
        const Eigen::VectorXd areas = triangle_areas(topology, metric);
        const int count =
            component.empty() ? 0 : 1 + *std::max_element(component.begin(), component.end());
        std::vector<double> area(at(count), 0);
        std::vector<int> triangles(at(count), 0);
        for (int t = 0; t < topology.triangle_count; ++t) {
            area[at(component[at(t)])] += areas[t];
            ++triangles[at(component[at(t)])];
        }
        std::vector<double> limit(at(topology.triangle_count));
        for (int t = 0; t < topology.triangle_count; ++t) {
            const int c = component[at(t)];
            limit[at(t)] = options.longest_edge;
            if (triangles[at(c)] < options.least_triangles && area[at(c)] > 0) {
                // Right-angled triangles with longest side l have an area of at most l^2 / 4.
                limit[at(t)] =
                    std::min(limit[at(t)], std::sqrt(4 * area[at(c)] / options.least_triangles));
            }
        }
        return limit;
    }

    bool is_wanted(int h) const {
        if (length_[at(h)] > limit_[at(parent_[at(h / 3)])]) return true;
        const int end = origin_[at(Topology::next(h))];
        return twin_[at(h)] >= 0 && is_boundary_[at(origin_[at(h)])] != 0 &&
               is_boundary_[at(end)] != 0 && !is_on_line(h);
    }

    bool is_on_line(int h) const {
        for (int k = 0; k < 3; ++k) {
            if (barycentric_[at(h)][k] == 0 && barycentric_[at(Topology::next(h))][k] == 0)
                return is_line_side_[at(3 * parent_[at(h / 3)] + (k + 1) % 3)] != 0;
        }
        return false;
    }

    void offer(int h) {
        const int other = twin_[at(h)];
        if (other >= 0 && other < h) h = other;
        if (is_wanted(h)) queue_.push({length_[at(h)], h});
    }

    /// Cuts the triangle (a, b, c) of `h` = a -> b into (a, w, c), in place, and (w, b, c), whose
    /// first half-edge is returned. Lengths of the two halves of `h` are left to the caller.
    int halve(int h, int w) {
        const int n = Topology::next(h);
        const int p = Topology::previous(h);
        const double ab = length_[at(h)];
        const double bc = length_[at(n)];
        const double ca = length_[at(p)];
        const int fresh = half_edge_count();
        parent_.push_back(parent_[at(h / 3)]);
        origin_.insert(origin_.end(), {w, origin_[at(n)], origin_[at(p)]});
        twin_.insert(twin_.end(), {-1, twin_[at(n)], n});
        const Vector3 middle = (barycentric_[at(h)] + barycentric_[at(n)]) / 2;
        const Vector3 b = barycentric_[at(n)];
        const Vector3 c = barycentric_[at(p)];
        barycentric_.insert(barycentric_.end(), {middle, b, c});
        const Vector2 place = (place_[at(h)] + place_[at(n)]) / 2;
        const Vector2 place_b = place_[at(n)];
        const Vector2 place_c = place_[at(p)];
        place_.insert(place_.end(), {place, place_b, place_c});
        place_[at(n)] = place;
        const double median = std::sqrt(std::max(0.0, 2 * (bc * bc + ca * ca) - ab * ab)) / 2;
        length_.insert(length_.end(), {ab / 2, bc, median});
        if (twin_[at(fresh + 1)] >= 0) twin_[at(twin_[at(fresh + 1)])] = fresh + 1;
        origin_[at(n)] = w;
        barycentric_[at(n)] = middle;
        twin_[at(n)] = fresh + 2;
        length_[at(n)] = median;
        return fresh;
    }

    void split(int h) {
        const int other = twin_[at(h)];
        const int w = vertex_count_++;
        is_boundary_.push_back(static_cast<char>(other < 0 || is_on_line(h)));
        const double half = length_[at(h)] / 2;
        const int far = halve(h, w);
        length_[at(h)] = half;
        std::vector<int> changed = {h / 3, far / 3};
        if (other >= 0) {
            const int far_other = halve(other, w);
            length_[at(other)] = half;
            twin_[at(h)] = far_other;
            twin_[at(far_other)] = h;
            twin_[at(far)] = other;
            twin_[at(other)] = far;
            changed.push_back(other / 3);
            changed.push_back(far_other / 3);
        }
        flip_to_delaunay(changed);
        for (const int t : changed) {
            for (int e = 3 * t; e < 3 * t + 3; ++e) offer(e);
        }
    }

    /// Flips edges between triangles of one input triangle, from those of `triangles` on, until
    /// they are Delaunay, which keeps the triangles of a split needle from becoming ever thinner.
    /// Adds the triangles that change.
    void flip_to_delaunay(std::vector<int>& triangles) {
        std::vector<int> stack;
        for (const int t : triangles) stack.insert(stack.end(), {3 * t, 3 * t + 1, 3 * t + 2});
        while (!stack.empty()) {
            const int h = stack.back();
            stack.pop_back();
            const int g = twin_[at(h)];
            if (g < 0 || parent_[at(g / 3)] != parent_[at(h / 3)] || !improves(h, g)) continue;
            flip(h, g);
            for (const int t : {h / 3, g / 3}) {
                stack.insert(stack.end(), {3 * t, 3 * t + 1, 3 * t + 2});
                triangles.push_back(t);
            }
        }
    }

    /// Whether flipping the edge of `h` and `g` keeps both triangles positive and takes the apex of
    /// one out of the circle of the other, beyond rounding.
    bool improves(int h, int g) const {
        const Vector2& a = place_[at(h)];
        const Vector2& b = place_[at(g)];
        const Vector2& c = place_[at(Topology::previous(h))];
        const Vector2& d = place_[at(Topology::previous(g))];
        const auto cross = [](const Vector2& u, const Vector2& v) {
            return u.x() * v.y() - u.y() * v.x();
        };
        const double tiny = 1e-9 * (b - a).squaredNorm();
        if (!(cross(d - a, c - a) > tiny) || !(cross(c - b, d - b) > tiny)) return false;
        const double at_c = cross(a - c, b - c);
        const double at_d = cross(b - d, a - d);
        return (a - c).dot(b - c) * at_d + (b - d).dot(a - d) * at_c <
               -1e-9 * (std::abs(at_c) + std::abs(at_d)) * (b - a).squaredNorm();
    }

    /// Triangles (a, b, c) of `h` = a -> b and (b, a, d) of `g` become (d, c, a) and (c, d, b),
    /// with c -> d in the slots of the old edge.
    void flip(int h, int g) {
        const int hn = Topology::next(h);
        const int hp = Topology::previous(h);
        const int gn = Topology::next(g);
        const int gp = Topology::previous(g);
        // The slot of b -> c takes d -> b's place and so on: corners move, then outer edges follow.
        const auto corner = [&](int e) {
            return Corner{origin_[at(e)], place_[at(e)], barycentric_[at(e)]};
        };
        const Corner a = corner(h);
        const Corner b = corner(g);
        const Corner c = corner(hp);
        const Corner d = corner(gp);
        const auto outer = [&](int e) { return Outer{twin_[at(e)], length_[at(e)]}; };
        const Outer bc = outer(hn);
        const Outer ca = outer(hp);
        const Outer ad = outer(gn);
        const Outer db = outer(gp);
        const double diagonal = (c.place - d.place).norm();
        put(h, d, {g, diagonal});
        put(hn, c, ca);
        put(hp, a, ad);
        put(g, c, {h, diagonal});
        put(gn, d, db);
        put(gp, b, bc);
    }

    struct Corner {
        int origin;
        Vector2 place;
        Vector3 barycentric;
    };
    struct Outer {
        int twin;
        double length;
    };
    void put(int h, const Corner& corner, const Outer& outer) {
        origin_[at(h)] = corner.origin;
        place_[at(h)] = corner.place;
        barycentric_[at(h)] = corner.barycentric;
        twin_[at(h)] = outer.twin;
        length_[at(h)] = outer.length;
        if (outer.twin >= 0) twin_[at(outer.twin)] = h;
    }

    int most_triangles_;
    int vertex_count_;
    std::vector<int> origin_;
    std::vector<int> twin_;
    std::vector<int> parent_;
    std::vector<Vector3> barycentric_;
    std::vector<Vector2> place_;  ///< of a corner in the plane of its input triangle
    std::vector<double> length_;
    std::vector<double> limit_;       ///< of a triangle of the input
    std::vector<char> is_boundary_;   ///< by vertex: on the boundary or on a line
    std::vector<char> is_line_side_;  ///< of a half-edge of the input: on a line
    std::priority_queue<Candidate> queue_;
};

}  // namespace

RefinedMesh refine_long_edges(const Topology& topology, const IntrinsicMetric& metric,
                              const RefineOptions& options, const Context& context) {
    Refinement refinement(topology, metric, options);
    refinement.run(context);
    return refinement.take();
}

}  // namespace kinequad
