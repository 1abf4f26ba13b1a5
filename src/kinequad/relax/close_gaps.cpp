// What relaxation does about the distance between quads and input in all frames.
#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <utility>

#include "kinequad/core/index.h"
#include "kinequad/core/parallel.h"
#include "kinequad/core/sort_unique.h"
#include "kinequad/mesh/closest_point_on_triangle.h"
#include "kinequad/relax/sliding_quads.h"

namespace kinequad {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double square(double x) { return x * x; }
double eighth_power(double squared) { return square(square(squared)); }

double squared_distance_to_quad(const Vector3& point, const QuadCorners& p) {
    const std::size_t k = end_of_cut(p);
    return std::min(
        closest_point_on_triangle(point, p[k], p[k + 1], p[k + 2]).squared_distance,
        closest_point_on_triangle(point, p[k], p[k + 2], p[(k + 3) % 4]).squared_distance);
}

}  // namespace

/// The distances between quads and input in all frames, kept up to date while vertices move. In
/// every frame the unit is `limit` mean lengths of the quads' edges there.
class SlidingQuads::Gaps {
public:
    Gaps(const SlidingQuads& quads, double limit, const Context& context) : sliding_(quads) {
        choose_points();
        choose_sides();
        views_.resize(sliding_.frames_.size());
        parallel_for(views_.size(), 1, context, [&](std::size_t f, std::size_t) {
            const Frame& frame = sliding_.frames_[f];
            views_[f].unit = limit * frame.mean_edge;
            look_at_all(f, context);
        });
    }

    /// The distance at every quad (q), at most over the frames, in units.
    std::vector<double> at_quads() const {
        std::vector<double> farthest(views_[0].of_quad.size(), 0);
        for (const View& view : views_) {
            for (std::size_t q = 0; q < farthest.size(); ++q) {
                farthest[q] = std::max(farthest[q], view.of_quad[q] / view.unit);
            }
            for (std::size_t x = 0; x < points_.size(); ++x) {
                double& of_nearest = farthest[at(view.nearest[x])];
                of_nearest = std::max(of_nearest, view.of_point[x] / view.unit);
            }
        }
        return farthest;
    }

    /// The quads farther away than `distance` units in some frame, the farthest first.
    std::vector<int> quads_beyond(double distance) const {
        const std::vector<double> farthest = at_quads();
        std::vector<std::pair<double, int>> far;
        for (std::size_t q = 0; q < farthest.size(); ++q) {
            if (farthest[q] > distance) far.emplace_back(-farthest[q], static_cast<int>(q));
        }
        std::sort(far.begin(), far.end());
        std::vector<int> quads;
        quads.reserve(far.size());
        for (const auto& [negative, q] : far) quads.push_back(q);
        return quads;
    }

    /// What changes as a vertex moves, and what is near.
    struct Surroundings {
        std::vector<int> quads;                ///< that change
        std::vector<int> patch;                ///< these first, and the ones around them
        std::vector<std::vector<int>> points;  ///< f: of the input, nearest to those that change
        std::vector<std::size_t> frames;       ///< the one with the largest distance first
        double misfit = 0;                     ///< over all frames, before anything moves
    };

    Surroundings surroundings(int v) const {
        Surroundings around;
        for (const int c : sliding_.corners_of(v)) around.quads.push_back(c / 4);
        sort_unique(around.quads);
        for (const int q : around.quads) {
            for (const int w : sliding_.vertices_around(q, 0)) {
                for (const int c : sliding_.corners_of(w)) around.patch.push_back(c / 4);
            }
        }
        sort_unique(around.patch);
        std::stable_partition(around.patch.begin(), around.patch.end(), [&](int q) {
            return std::binary_search(around.quads.begin(), around.quads.end(), q);
        });
        std::vector<std::pair<double, std::size_t>> order;
        for (std::size_t f = 0; f < views_.size(); ++f) {
            const View& view = views_[f];
            std::vector<int>& points = around.points.emplace_back();
            double farthest = 0;
            for (const int q : around.quads) {
                farthest = std::max(farthest, view.of_quad[at(q)]);
                for (const int x : view.points_of[at(q)]) {
                    points.push_back(x);
                    farthest = std::max(farthest, view.of_point[at(x)]);
                }
            }
            // The farthest first: most places that are no better show it there.
            std::sort(points.begin(), points.end(), [&](int x, int y) {
                const double of_x = view.of_point[at(x)];
                const double of_y = view.of_point[at(y)];
                return of_x != of_y ? of_x > of_y : x < y;
            });
            order.emplace_back(-farthest / view.unit, f);
            around.misfit += eighth_power(square(farthest / view.unit));
        }
        std::sort(order.begin(), order.end());
        for (const auto& [negative, f] : order) around.frames.push_back(f);
        const View& worst = views_[around.frames.front()];
        std::sort(around.quads.begin(), around.quads.end(), [&](int q, int r) {
            const double of_q = worst.of_quad[at(q)];
            const double of_r = worst.of_quad[at(r)];
            return of_q != of_r ? of_q > of_r : q < r;
        });
        return around;
    }

    /// Sum of the eighth powers of the largest distances in the first `frames` of the frames of
    /// `around`; does not add up beyond `enough`.
    double misfit(const Surroundings& around, std::size_t frames, double enough) const {
        double sum = 0;
        for (std::size_t i = 0; i < frames && sum < enough; ++i) {
            const std::size_t f = around.frames[i];
            const double squared_unit = square(views_[f].unit);
            const double left = enough - sum;
            const double too_far =
                left < infinity ? squared_unit * std::sqrt(std::sqrt(left)) : infinity;
            sum += eighth_power(squared_distance(around, f, too_far) / squared_unit);
        }
        return sum;
    }

    /// Looks again at what has changed.
    void update(const Surroundings& around) {
        for (std::size_t f = 0; f < views_.size(); ++f) {
            View& view = views_[f];
            for (const int q : around.quads) {
                view.of_quad[at(q)] = std::sqrt(squared_distance_of(q, f));
                view.points_of[at(q)].clear();
            }
            const double near_distance = near_share * sliding_.frames_[f].mean_edge;
            for (const int x : around.points[f]) {
                const auto [squared, q] = nearest_in(around.patch, x, f, square(near_distance));
                view.nearest[at(x)] = q;
                view.points_of[at(q)].push_back(x);
                view.of_point[at(x)] = std::sqrt(squared);
            }
        }
    }

private:
    /// A point of the input that is looked at, on the edge from vertex `a` to vertex `b`.
    struct EdgePoint {
        int a;
        int b;
        double share;  ///< 0 at `a`, 1 at `b`

        Vector3 position(const Positions& X) const {
            return ((1 - share) * X.row(a) + share * X.row(b)).transpose();
        }
    };

    /// Distances in one frame, in units of the input.
    struct View {
        double unit = 1;
        std::vector<double> of_quad;              ///< q: from the quad to the input
        std::vector<double> of_point;             ///< x: from the point to the quads
        std::vector<int> nearest;                 ///< x: the quad it is nearest to
        std::vector<std::vector<int>> points_of;  ///< q: the points nearest to it
    };

    /// All vertices, and points between the ends of edges that are long for the quads.
    void choose_points() {
        constexpr double spacing = 0.7;
        constexpr double most_parts = 8;
        const Topology& topology = sliding_.topology_;
        for (int v = 0; v < topology.vertex_count; ++v) {
            if (topology.vertex_half_edge[at(v)] >= 0) points_.push_back({v, v, 0});
        }
        for (int h = 0; h < 3 * topology.triangle_count; ++h) {
            if (topology.twin[at(h)] > h) continue;
            const int a = sliding_.F_(h / 3, h % 3);
            const int b = sliding_.F_(h / 3, (h + 1) % 3);
            double length = 0;
            for (const Frame& frame : sliding_.frames_) {
                const double here = (frame.input.row(a) - frame.input.row(b)).norm();
                length = std::max(length, here / frame.mean_edge);
            }
            const int parts = static_cast<int>(std::min(most_parts, std::ceil(length / spacing)));
            for (int i = 1; i < parts; ++i) {
                points_.push_back({a, b, static_cast<double>(i) / parts});
            }
        }
    }

    /// Gives every side to the first quad that has it.
    void choose_sides() {
        std::vector<std::array<int, 3>> sides;
        for (int c = 0; c < static_cast<int>(sliding_.quads_.Q.size()); ++c) {
            const auto [a, b] = std::minmax({sliding_.neighbour(c, 0), sliding_.neighbour(c, 1)});
            sides.push_back({a, b, c});
        }
        std::sort(sides.begin(), sides.end());
        owns_side_.assign(sides.size(), 1);
        for (std::size_t i = 1; i < sides.size(); ++i) {
            const bool is_known = sides[i][0] == sides[i - 1][0] && sides[i][1] == sides[i - 1][1];
            if (is_known) owns_side_[at(sides[i][2])] = 0;
        }
    }

    void look_at_all(std::size_t f, const Context& context) {
        const Frame& frame = sliding_.frames_[f];
        View& view = views_[f];
        const Quads& Q = sliding_.quads_.Q;
        view.points_of.resize(at(static_cast<int>(Q.rows())));
        for (int q = 0; q < static_cast<int>(Q.rows()); ++q) {
            if (q % 4096 == 0) context.check_cancelled();
            view.of_quad.push_back(std::sqrt(squared_distance_of(q, f)));
        }
        const ClosestPoints quads(frame.vertices, cut_quads(Q, frame.vertices));
        int hint = -1;
        for (std::size_t x = 0; x < points_.size(); ++x) {
            if (x % 4096 == 0) context.check_cancelled();
            const ClosestPoint closest = quads.find(points_[x].position(frame.input), hint);
            hint = closest.point.triangle;
            view.nearest.push_back(hint / 2);
            view.points_of[at(hint / 2)].push_back(static_cast<int>(x));
            view.of_point.push_back(std::sqrt(closest.squared_distance));
        }
    }

    /// Squared distance of point `x` to the nearest of `quads`, or to one that is not farther than
    /// `enough`, and that quad.
    std::pair<double, int> nearest_in(const std::vector<int>& quads, int x, std::size_t f,
                                      double enough) const {
        const Frame& frame = sliding_.frames_[f];
        const Vector3 point = points_[at(x)].position(frame.input);
        std::pair<double, int> nearest = {infinity, -1};
        for (const int q : quads) {
            const double here = squared_distance_to_quad(point, sliding_.corners_in(frame, q));
            if (here < nearest.first) nearest = {here, q};
            if (nearest.first <= enough) break;
        }
        return nearest;
    }

    /// The largest around; or the first that is above `too_far`.
    double squared_distance(const Surroundings& around, std::size_t f, double too_far) const {
        double farthest = 0;
        for (const int q : around.quads) {
            farthest = std::max(farthest, squared_distance_of(q, f));
            if (farthest > too_far) return farthest;
        }
        for (const int x : around.points[f]) {
            farthest = std::max(farthest, nearest_in(around.patch, x, f, farthest).first);
            if (farthest > too_far) return farthest;
        }
        return farthest;
    }

    /// Largest squared distance of points of a quad to the input: on the sides that are its own, on
    /// the shorter diagonal and inside the two triangles; on more of them where one is not near.
    /// What is near counts as `near_share`.
    double squared_distance_of(int quad, std::size_t f) const {
        const Frame& frame = sliding_.frames_[f];
        const QuadCorners p = sliding_.corners_in(frame, quad);
        const std::size_t k = end_of_cut(p);
        const double near_distance = near_share * frame.mean_edge;
        double farthest = square(near_distance);
        const auto ask = [&](const Vector3& point, int hint) {
            const ClosestPoint found = frame.surface->find_unless_near(farthest, point, hint);
            const bool is_beyond = found.squared_distance > farthest;
            if (is_beyond) farthest = found.squared_distance;
            return is_beyond;
        };
        const auto at_corner = [&](std::size_t corner) {
            const int v = sliding_.quads_.Q(quad, static_cast<int>(corner));
            return sliding_.quads_.vertex[at(v)].triangle;
        };
        const auto at_middle = [&](std::size_t side) {
            return sliding_.hints_[at(5 * quad) + side];
        };
        const auto ask_on_lines = [&](std::initializer_list<double> shares) {
            bool is_any_far = false;
            for (std::size_t i = 0; i < 5; ++i) {
                if (i < 4 && owns_side_[at(4 * quad) + i] == 0) continue;
                const std::size_t a = i < 4 ? i : k;
                const std::size_t b = i < 4 ? (i + 1) % 4 : k + 2;
                for (const double share : shares) {
                    const Vector3 point = p[a] + share * (p[b] - p[a]);
                    const int hint = share == 0.5 ? at_middle(i) : at_corner(share < 0.5 ? a : b);
                    if (ask(point, hint)) is_any_far = true;
                }
            }
            return is_any_far;
        };
        const bool is_line_far = ask_on_lines({0.5, 0.25, 0.75});
        const bool is_first_far = ask((p[k] + p[k + 1] + p[k + 2]) / 3, at_middle(4));
        const bool is_second_far = ask((p[k] + p[k + 2] + p[(k + 3) % 4]) / 3, at_middle(4));
        if (is_line_far || is_first_far || is_second_far) {
            ask_on_lines({0.125, 0.375, 0.625, 0.875});
        }
        return farthest;
    }

    const SlidingQuads& sliding_;
    std::vector<EdgePoint> points_;  ///< of the input
    std::vector<char> owns_side_;    ///< corner c: whether the side that begins there is looked at
    std::vector<View> views_;        ///< f
};

/// Moves vertex `v` to where quads and input are closer in all frames, and angles not much worse.
/// Returns whether there is such a place.
bool SlidingQuads::close_gaps_at(int v, Gaps& gaps) {
    // Where places are compared, the frames with the largest distances are enough.
    constexpr std::size_t compared_frames = 3;
    constexpr double shape_weight = 3;
    constexpr double least_kept_jacobian = 0.1;
    static const Steps steps{6, {0.4, 0.16, 0.06}, true};
    const Gaps::Surroundings around = gaps.surroundings(v);
    const SurfacePoint before = quads_.vertex[at(v)];
    const double least_jacobian = std::min(least_jacobian_around(v), least_kept_jacobian);
    const double longest = std::max(longest_edge(v), most_stretch);
    const auto shape_cost = [&] {
        return shape_weight * cost_around(v, relaxing_barrier) /
               static_cast<double>(frames_.size());
    };
    const auto cost = [&](std::size_t frames, double enough) {
        const double shape = shape_cost();
        if (shape >= enough) return shape;
        return shape + gaps.misfit(around, std::min(frames, frames_.size()), enough - shape);
    };
    const double cost_before = shape_cost() + around.misfit;
    const bool is_moved = search_around(v, steps, [&](double least) {
        if (least_jacobian_around(v) < least_jacobian || longest_edge(v) > longest) return least;
        return cost(compared_frames, least);
    });
    if (!is_moved) return false;
    if (cost(frames_.size(), cost_before) >= cost_before) {
        place(v, before);
        return false;
    }
    gaps.update(around);
    return true;
}

std::vector<double> SlidingQuads::close_gaps(double limit, const Context& context) {
    constexpr int rounds = 8;
    constexpr double looked_at_share = 0.8;
    release();
    parallel_for(frames_.size(), 1, context, [&](std::size_t f, std::size_t) {
        if (!frames_[f].surface) frames_[f].surface.emplace(frames_[f].input, F_);
    });
    Gaps gaps(*this, limit, context);
    // A search costs time: there is one for every other vertex, on average.
    std::size_t searches_left = quads_.vertex.size() / 2;
    std::vector<char> is_settled(quads_.vertex.size(), 0);
    for (int round = 0; round < rounds; ++round) {
        bool is_moved = false;
        for (const int q : gaps.quads_beyond(looked_at_share)) {
            for (const int v : vertices_around(q, 1)) {
                if (is_pinned_[at(v)] != 0 || is_settled[at(v)] != 0 || searches_left == 0)
                    continue;
                context.check_cancelled();
                --searches_left;
                is_settled[at(v)] = 1;
                if (!close_gaps_at(v, gaps)) continue;
                is_moved = true;
                for (const int c : corners_of(v)) {
                    for (const int w : vertices_around(c / 4, 1)) is_settled[at(w)] = 0;
                }
            }
        }
        if (!is_moved) break;
    }
    return gaps.at_quads();
}

}  // namespace kinequad
