#include "kinequad/measure/directed_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "kinequad/core/index.h"
#include "kinequad/core/parallel.h"
#include "kinequad/mesh/closest_point_on_triangle.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {
namespace {

constexpr std::size_t block_size = 256;

constexpr double unknown = std::numeric_limits<double>::infinity();

/// Distance of a point to the target, and the triangle that is nearest to it.
struct Found {
    double distance = unknown;
    int triangle = -1;
};

/// A piece of a triangle on which the distance may still exceed the largest one found.
struct Piece {
    std::array<Vector3, 3> corner;
    std::array<Found, 3> at_corner;  ///< distance `unknown` where it was not asked for
    Found at_center;
    double bound;  ///< no point of the piece is farther from the target

    Vector3 center() const { return triangle_centre(corner[0], corner[1], corner[2]); }
};

/// No point of the triangle `a`, `b`, `c` is farther than this from the nearest of its corners.
double reach_of_corners(const Vector3& a, const Vector3& b, const Vector3& c) {
    std::array<Vector3, 3> side = {c - b, a - c, b - a};
    std::array<double, 3> squared = {side[0].squaredNorm(), side[1].squaredNorm(),
                                     side[2].squaredNorm()};
    const std::size_t longest = static_cast<std::size_t>(
        std::max_element(squared.begin(), squared.end()) - squared.begin());
    std::swap(side[longest], side[2]);
    std::swap(squared[longest], squared[2]);
    if (squared[0] + squared[1] > squared[2]) {
        // Acute: the centre of the circumscribed circle is inside.
        const double doubled_area = side[0].cross(side[1]).norm();
        if (doubled_area > 1e-6 * squared[2]) {
            return std::sqrt(squared[0] * squared[1] * squared[2]) / (2 * doubled_area);
        }
    } else {
        // Obtuse: the farthest points lie on the longest side, as far from one of its ends as from
        // the opposite corner.
        const double first = std::abs(side[0].dot(side[2]));
        const double second = std::abs(side[1].dot(side[2]));
        const double length = std::sqrt(squared[2]);
        if (std::min(first, second) > 1e-6 * squared[2]) {
            return 0.5 * length * std::max(squared[0] / first, squared[1] / second);
        }
    }
    return std::sqrt(squared[2]);
}

class DirectedMeter {
public:
    DirectedMeter(const Positions& V, const Triangles& F, const ClosestPoints& target,
                  double diagonal, const DistanceOptions& options, const Context& context)
        : V_(V),
          F_(F),
          target_(target),
          context_(context),
          diagonal_(diagonal),
          options_(options) {}

    DirectedDistance run(DistanceHints& hints) {
        hints.vertex.resize(static_cast<std::size_t>(V_.rows()), -1);
        hints.center.resize(static_cast<std::size_t>(F_.rows()), -1);
        visit_vertices(hints.vertex);
        choose_spacing();
        visit_triangles(hints);
        refine();
        const double to_percent = 100 / diagonal_;
        return {largest_ * to_percent, std::max(largest_, bound_) * to_percent, mean_ * to_percent,
                spacing_ * to_percent, samples_};
    }

private:
    Vector3 vertex(int t, int k) const { return V_.row(F_(t, k)).transpose(); }

    Found find(const Vector3& point, int hint) const {
        const ClosestPoint found = target_.find(point, hint);
        return {std::sqrt(found.squared_distance), found.point.triangle};
    }

    double tolerated(double distance) const {
        return distance * (1 + options_.relative_tolerance) +
               options_.absolute_tolerance_percent / 100 * diagonal_;
    }

    void visit_vertices(std::vector<int>& hints) {
        vertex_distance_.assign(hints.size(), 0);
        std::vector<char> is_used(hints.size(), 0);
        for (Eigen::Index i = 0; i < F_.size(); ++i) is_used[at(F_.data()[i])] = 1;
        const std::size_t blocks = (hints.size() + block_size - 1) / block_size;
        std::vector<double> largest(blocks, 0);
        std::vector<int> used(blocks, 0);
        parallel_for(hints.size(), block_size, context_, [&](std::size_t begin, std::size_t end) {
            const std::size_t block = begin / block_size;
            int last = -1;
            for (std::size_t v = begin; v < end; ++v) {
                if (is_used[v] == 0) continue;
                const Found found = find(V_.row(static_cast<Eigen::Index>(v)).transpose(),
                                         hints[v] >= 0 ? hints[v] : last);
                hints[v] = last = found.triangle;
                vertex_distance_[v] = found.distance;
                largest[block] = std::max(largest[block], found.distance);
                ++used[block];
            }
        });
        for (std::size_t block = 0; block < blocks; ++block) {
            largest_ = std::max(largest_, largest[block]);
            samples_ += used[block];
        }
    }

    /// Into how many parts a triangle's sides are cut: a power of two. Whole, its points are near
    /// to its centre or a corner; else a point of a piece is at most two thirds of the piece's
    /// longest side away from the piece's centre.
    int parts(int t) const {
        const Vector3 a = vertex(t, 0);
        const Vector3 b = vertex(t, 1);
        const Vector3 c = vertex(t, 2);
        const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
        if (2 * longest <= 3 * spacing_) return 1;
        const Vector3 center = triangle_centre(a, b, c);
        if (std::max({reach_of_corners(a, b, center), reach_of_corners(b, c, center),
                      reach_of_corners(c, a, center)}) <= spacing_) {
            return 1;
        }
        int n = 2;
        while (n < 4096 && 2 * longest > 3 * n * spacing_) n *= 2;
        return n;
    }

    void choose_spacing() {
        spacing_ = options_.spacing_percent / 100 * diagonal_;
        for (;; spacing_ *= 2) {
            std::int64_t count = 0;
            bool is_least = true;
            for (int t = 0; t < F_.rows(); ++t) {
                const std::int64_t n = parts(t);
                count += n * n;
                is_least = is_least && n == 1;
            }
            if (is_least || count <= options_.sample_limit) {
                samples_ += static_cast<int>(std::min<std::int64_t>(count, 1 << 30));
                return;
            }
        }
    }

    struct Block {
        double area = 0;
        double area_distance = 0;
        double largest = 0;
        std::vector<Piece> open;
    };

    void visit_triangles(DistanceHints& hints) {
        const auto count = static_cast<std::size_t>(F_.rows());
        std::vector<Block> blocks((count + block_size - 1) / block_size);
        parallel_for(count, block_size, context_, [&](std::size_t begin, std::size_t end) {
            Block& block = blocks[begin / block_size];
            for (std::size_t t = begin; t < end; ++t)
                visit_triangle(static_cast<int>(t), hints.vertex, hints.center, block);
        });
        double area = 0;
        double area_distance = 0;
        for (Block& block : blocks) {
            area += block.area;
            area_distance += block.area_distance;
            largest_ = std::max(largest_, block.largest);
            open_.insert(open_.end(), block.open.begin(), block.open.end());
        }
        mean_ = area > 0 ? area_distance / area : largest_;
    }

    void visit_triangle(int t, const std::vector<int>& hints, std::vector<int>& center_hints,
                        Block& block) const {
        const Vector3 origin = vertex(t, 0);
        const int n = parts(t);
        const Vector3 u = (vertex(t, 1) - origin) / n;
        const Vector3 v = (vertex(t, 2) - origin) / n;
        const double area = 0.5 * u.cross(v).norm() * n * n;
        // All pieces are congruent up to a half turn, and so are their radii.
        const double radius = std::sqrt(std::max({(u + v).squaredNorm(), (2 * u - v).squaredNorm(),
                                                  (2 * v - u).squaredNorm()})) /
                              3;
        const double largest_before = tolerated(largest_);
        double sum = 0;
        int& center_hint = center_hints[at(t)];
        int hint = center_hint >= 0 ? center_hint : hints[at(F_(t, 0))];
        std::array<Found, 3> at_corner;
        for (std::size_t k = 0; n == 1 && k < 3; ++k) {
            const auto v = static_cast<std::size_t>(F_(t, static_cast<int>(k)));
            at_corner[k] = {vertex_distance_[v], hints[v]};
        }
        const auto visit = [&](const Vector3& a, const Vector3& b, const Vector3& c) {
            const Found found = find(triangle_centre(a, b, c), hint);
            hint = found.triangle;
            sum += found.distance;
            block.largest = std::max(block.largest, found.distance);
            if (found.distance + radius <= largest_before) return;
            Piece piece{{a, b, c}, at_corner, found, 0};
            piece.bound = bound_of(piece, largest_before);
            if (piece.bound > largest_before) block.open.push_back(piece);
        };
        for (int i = 0; i < n; ++i) {
            for (int j = 0; i + j < n; ++j) {
                const Vector3 p = origin + i * u + j * v;
                visit(p, p + u, p + v);
                if (i + j + 1 < n) visit(p + u + v, p + v, p + u);
            }
        }
        center_hint = hint;
        // With this share for the corners the rule is exact for quadratic functions.
        const double corner_weight = 1.0 / (9.0 * n * n + 3);
        double corner_sum = 0;
        for (int k = 0; k < 3; ++k) corner_sum += vertex_distance_[at(F_(t, k))];
        const double mean =
            corner_weight * corner_sum + (1 - 3 * corner_weight) * sum / (double(n) * n);
        block.area += area;
        block.area_distance += area * mean;
    }

    /// Largest distance of the corners of a triangle to triangle `t` of the target. The distance to
    /// one triangle is convex, so that no point of the former is farther from the target.
    double distance_to(int t, const Vector3& a, const Vector3& b, const Vector3& c) const {
        const auto corners = target_.triangles().row(t);
        const Positions& W = target_.positions();
        const Vector3 p = W.row(corners[0]).transpose();
        const Vector3 q = W.row(corners[1]).transpose();
        const Vector3 r = W.row(corners[2]).transpose();
        return std::sqrt(std::max({closest_point_on_triangle(a, p, q, r).squared_distance,
                                   closest_point_on_triangle(b, p, q, r).squared_distance,
                                   closest_point_on_triangle(c, p, q, r).squared_distance}));
    }

    /// The distance changes by at most the way gone: from the centre, or from the nearest of centre
    /// and corners.
    static double bound_by_reach(const Piece& piece) {
        const Vector3 center = piece.center();
        double reach2 = 0;
        for (const Vector3& corner : piece.corner) {
            reach2 = std::max(reach2, (corner - center).squaredNorm());
        }
        double between = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t next = (k + 1) % 3;
            const double most = std::max({piece.at_center.distance, piece.at_corner[k].distance,
                                          piece.at_corner[next].distance});
            between = std::max(
                between, most + reach_of_corners(piece.corner[k], piece.corner[next], center));
        }
        return std::min(piece.at_center.distance + std::sqrt(reach2), between);
    }

    /// The piece cut in four, each quarter by its distance to the one triangle that is nearest to
    /// the piece's centre, or nearest to the corner that it keeps.
    double bound_by_quarters(const Piece& piece) const {
        const auto& [a, b, c] = piece.corner;
        const std::array<Vector3, 3> middle = {0.5 * (b + c), 0.5 * (c + a), 0.5 * (a + b)};
        const int t = piece.at_center.triangle;
        double bound = distance_to(t, middle[0], middle[1], middle[2]);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vector3& p = middle[(k + 1) % 3];
            const Vector3& q = middle[(k + 2) % 3];
            double quarter = distance_to(t, piece.corner[k], p, q);
            const int other = piece.at_corner[k].triangle;
            if (other >= 0 && other != t) {
                quarter = std::min(quarter, distance_to(other, piece.corner[k], p, q));
            }
            bound = std::max(bound, quarter);
        }
        return bound;
    }

    /// An upper bound of the distance on a piece: the least of three, which are tried in turn until
    /// one is at most `enough`. docs/measures.md
    double bound_of(const Piece& piece, double enough) const {
        double bound = bound_by_reach(piece);
        if (bound <= enough) return bound;
        bound = std::min(bound, distance_to(piece.at_center.triangle, piece.corner[0],
                                            piece.corner[1], piece.corner[2]));
        if (bound <= enough) return bound;
        return std::min(bound, bound_by_quarters(piece));
    }

    /// Cuts the piece in four; returns the largest distance seen on the way.
    double split(const Piece& piece, double enough, std::array<Piece, 4>& children) const {
        const auto& [a, b, c] = piece.corner;
        const auto& [at_a, at_b, at_c] = piece.at_corner;
        const Vector3 ab = 0.5 * (a + b);
        const Vector3 bc = 0.5 * (b + c);
        const Vector3 ca = 0.5 * (c + a);
        const int hint = piece.at_center.triangle;
        const Found at_ab = find(ab, hint);
        const Found at_bc = find(bc, hint);
        const Found at_ca = find(ca, hint);
        double largest = std::max({at_ab.distance, at_bc.distance, at_ca.distance});
        children = {Piece{{a, ab, ca}, {at_a, at_ab, at_ca}, {}, 0},
                    Piece{{ab, b, bc}, {at_ab, at_b, at_bc}, {}, 0},
                    Piece{{ca, bc, c}, {at_ca, at_bc, at_c}, {}, 0},
                    Piece{{ab, bc, ca}, {at_ab, at_bc, at_ca}, {}, 0}};
        for (Piece& child : children) {
            child.at_center = find(child.center(), hint);
            largest = std::max(largest, child.at_center.distance);
            child.bound = std::min(piece.bound, bound_of(child, enough));
        }
        return largest;
    }

    void drop_settled() {
        const double enough = tolerated(largest_);
        std::erase_if(open_, [&](const Piece& piece) {
            if (piece.bound > enough) return false;
            bound_ = std::max(bound_, piece.bound);
            return true;
        });
    }

    /// Level by level, the most promising pieces first, so that neither the number of threads nor
    /// their order changes which ones are split.
    void refine() {
        constexpr int samples_per_split = 7;
        int left = options_.refinement_limit / samples_per_split;
        bound_ = tolerated(largest_);
        for (drop_settled(); !open_.empty() && left > 0; drop_settled()) {
            std::stable_sort(open_.begin(), open_.end(),
                             [](const Piece& a, const Piece& b) { return a.bound > b.bound; });
            const std::size_t count =
                std::min<std::size_t>({open_.size(), std::size_t(left), 1024});
            std::vector<std::array<Piece, 4>> children(count);
            std::vector<double> largest(count);
            const double enough = tolerated(largest_);
            parallel_for(count, 16, context_, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                    largest[i] = split(open_[i], enough, children[i]);
                }
            });
            left -= static_cast<int>(count);
            samples_ += samples_per_split * static_cast<int>(count);
            open_.erase(open_.begin(), open_.begin() + static_cast<std::ptrdiff_t>(count));
            for (std::size_t i = 0; i < count; ++i) {
                largest_ = std::max(largest_, largest[i]);
                open_.insert(open_.end(), children[i].begin(), children[i].end());
            }
        }
        for (const Piece& piece : open_) bound_ = std::max(bound_, piece.bound);
    }

    const Positions& V_;
    const Triangles& F_;
    const ClosestPoints& target_;
    const Context& context_;
    double diagonal_;
    const DistanceOptions& options_;
    double spacing_ = 0;
    double largest_ = 0;
    double bound_ = 0;
    double mean_ = 0;
    int samples_ = 0;
    std::vector<double> vertex_distance_;
    std::vector<Piece> open_;
};

}  // namespace

DirectedDistance measure_directed_distance(const Positions& V, const Triangles& F,
                                           const ClosestPoints& target, double diagonal,
                                           const DistanceOptions& options, DistanceHints& hints,
                                           const Context& context) {
    return DirectedMeter(V, F, target, diagonal, options, context).run(hints);
}

}  // namespace kinequad
