#include "kinequad/measure/directed_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "kinequad/core/parallel.h"
#include "kinequad/mesh/closest_point_on_triangle.h"

namespace kinequad {
namespace {

constexpr std::size_t block_size = 256;

/// A piece of a triangle on which the distance may still exceed the largest one found.
struct Piece {
    std::array<Vector3, 3> corner;
    double center_distance;
    int nearest;   ///< triangle of the target nearest to the centre
    double bound;  ///< no point of the piece is farther from the target
};

struct Found {
    double distance;
    int triangle;
};

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

    DirectedDistance run(std::vector<int>& hints) {
        visit_vertices(hints);
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
        for (Eigen::Index i = 0; i < F_.size(); ++i)
            is_used[static_cast<std::size_t>(F_.data()[i])] = 1;
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

    /// Into how many parts a triangle's sides are cut: a power of two. A point of a
    /// piece is at most two thirds of the piece's longest side away from its centre.
    int parts(int t) const {
        const double longest =
            std::max({(vertex(t, 1) - vertex(t, 0)).norm(), (vertex(t, 2) - vertex(t, 1)).norm(),
                      (vertex(t, 0) - vertex(t, 2)).norm()});
        int n = 1;
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

    void visit_triangles(const std::vector<int>& hints) {
        const auto count = static_cast<std::size_t>(F_.rows());
        std::vector<Block> blocks((count + block_size - 1) / block_size);
        parallel_for(count, block_size, context_, [&](std::size_t begin, std::size_t end) {
            Block& block = blocks[begin / block_size];
            for (std::size_t t = begin; t < end; ++t)
                visit_triangle(static_cast<int>(t), hints, block);
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

    void visit_triangle(int t, const std::vector<int>& hints, Block& block) const {
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
        int hint = hints[static_cast<std::size_t>(F_(t, 0))];
        const auto visit = [&](const Vector3& a, const Vector3& b, const Vector3& c) {
            const Found found = find((a + b + c) / 3, hint);
            hint = found.triangle;
            sum += found.distance;
            block.largest = std::max(block.largest, found.distance);
            if (found.distance + radius <= largest_before) return;
            Piece piece{{a, b, c}, found.distance, found.triangle, 0};
            piece.bound = bound_of(piece);
            if (piece.bound > largest_before) block.open.push_back(piece);
        };
        for (int i = 0; i < n; ++i) {
            for (int j = 0; i + j < n; ++j) {
                const Vector3 p = origin + i * u + j * v;
                visit(p, p + u, p + v);
                if (i + j + 1 < n) visit(p + u + v, p + v, p + u);
            }
        }
        // With this share for the corners the rule is exact for quadratic functions.
        const double corner_weight = 1.0 / (9.0 * n * n + 3);
        double corner_sum = 0;
        for (int k = 0; k < 3; ++k)
            corner_sum += vertex_distance_[static_cast<std::size_t>(F_(t, k))];
        const double mean =
            corner_weight * corner_sum + (1 - 3 * corner_weight) * sum / (double(n) * n);
        block.area += area;
        block.area_distance += area * mean;
    }

    /// Two upper bounds of the distance on a piece. The distance changes by at most the way gone;
    /// and the distance to one triangle, being convex, is largest in a corner.
    double bound_of(const Piece& piece) const {
        const Vector3 center = (piece.corner[0] + piece.corner[1] + piece.corner[2]) / 3;
        const auto corners = target_.triangles().row(piece.nearest);
        const Positions& W = target_.positions();
        double reach2 = 0;
        double corner2 = 0;
        for (const Vector3& corner : piece.corner) {
            reach2 = std::max(reach2, (corner - center).squaredNorm());
            corner2 =
                std::max(corner2, closest_point_on_triangle(corner, W.row(corners[0]).transpose(),
                                                            W.row(corners[1]).transpose(),
                                                            W.row(corners[2]).transpose())
                                      .squared_distance);
        }
        return std::min(piece.center_distance + std::sqrt(reach2), std::sqrt(corner2));
    }

    /// Cuts the piece in four; returns the largest distance seen on the way.
    double split(const Piece& piece, std::array<Piece, 4>& children) const {
        const auto& [a, b, c] = piece.corner;
        const Vector3 ab = 0.5 * (a + b);
        const Vector3 bc = 0.5 * (b + c);
        const Vector3 ca = 0.5 * (c + a);
        double largest = 0;
        for (const Vector3& middle : {ab, bc, ca}) {
            largest = std::max(largest, find(middle, piece.nearest).distance);
        }
        const std::array<std::array<Vector3, 3>, 4> corners = {
            {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}};
        for (std::size_t k = 0; k < 4; ++k) {
            const auto& corner = corners[k];
            const Found found = find((corner[0] + corner[1] + corner[2]) / 3, piece.nearest);
            largest = std::max(largest, found.distance);
            children[k] = {corner, found.distance, found.triangle, 0};
            children[k].bound = std::min(piece.bound, bound_of(children[k]));
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
            parallel_for(count, 16, context_, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) largest[i] = split(open_[i], children[i]);
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
                                           const DistanceOptions& options, std::vector<int>& hints,
                                           const Context& context) {
    return DirectedMeter(V, F, target, diagonal, options, context).run(hints);
}

}  // namespace kinequad
