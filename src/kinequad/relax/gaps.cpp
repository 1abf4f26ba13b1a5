#include "kinequad/relax/gaps.h"

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

namespace kinequad {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Where all frames count, quads with a sample that is not near, or with a line longer than samples
/// are dense enough for, in mean lengths of edges, are searched for the largest distance beyond so
/// many units. That much, in mean lengths, is not told apart there; less where only the farthest
/// quads are looked at.
constexpr double densely_sampled = 1.75;
constexpr double worth_a_closer_look = 0.8;
constexpr double told_apart = 0.08;
constexpr double finely_told_apart = 0.04;

/// Where places are compared, the frames with the largest distances are enough at first.
constexpr std::size_t compared_frames = 3;

double square(double x) { return x * x; }

double squared_distance_to_quad(const Vector3& point, const QuadCorners& p) {
    const std::size_t k = end_of_cut(p);
    return std::min(
        closest_point_on_triangle(point, p[k], p[k + 1], p[k + 2]).squared_distance,
        closest_point_on_triangle(point, p[k], p[k + 2], p[(k + 3) % 4]).squared_distance);
}

/// The longest side of a quad, or the diagonal that it is cut along.
double longest_line(const QuadCorners& p) {
    const std::size_t k = end_of_cut(p);
    double longest = (p[k + 2] - p[k]).norm();
    for (std::size_t i = 0; i < 4; ++i) longest = std::max(longest, (p[(i + 1) % 4] - p[i]).norm());
    return longest;
}

}  // namespace

SlidingQuads::Gaps::Gaps(const SlidingQuads& quads, const GapOptions& options,
                         const Context& context)
    : sliding_(quads),
      shape_weight_(options.shape_weight),
      most_stretch_(options.most_stretch),
      told_apart_(options.only_farthest ? finely_told_apart : told_apart),
      every_frame_counts_(options.every_frame_counts) {
    choose_points();
    choose_sides();
    distances_.resize(sliding_.frames_.size());
    parallel_for(distances_.size(), 1, context, [&](std::size_t f, std::size_t) {
        const Frame& frame = sliding_.frames_[f];
        distances_[f].unit = options.limit * frame.mean_edge;
        distances_[f].squared_near = square(
            (options.every_frame_counts ? roughly_near_share : near_share) * frame.mean_edge);
        look_at_quads(f, context);
        look_at_points(f, context);
    });
    const std::size_t known = points_.size();
    choose_more_points(options);
    if (points_.size() == known) return;
    parallel_for(distances_.size(), 1, context,
                 [&](std::size_t f, std::size_t) { look_at_points(f, context); });
}

/// What a distance counts whose square is this many squared units.
double SlidingQuads::Gaps::misfit_of(double squared) const {
    const double eighth_power = square(square(squared));
    return every_frame_counts_ ? square(eighth_power) : eighth_power;
}

/// The square of the distance that counts this much, in squared units.
double SlidingQuads::Gaps::squared_distance_with(double misfit) const {
    return std::sqrt(std::sqrt(every_frame_counts_ ? std::sqrt(misfit) : misfit));
}

std::vector<double> SlidingQuads::Gaps::at_quads() const {
    std::vector<double> farthest(distances_[0].of_quad.size(), 0);
    for (const FrameDistances& in_frame : distances_) {
        for (std::size_t q = 0; q < farthest.size(); ++q) {
            farthest[q] = std::max(farthest[q], in_frame.of_quad[q] / in_frame.unit);
        }
        for (std::size_t x = 0; x < points_.size(); ++x) {
            double& of_nearest = farthest[at(in_frame.nearest[x])];
            of_nearest = std::max(of_nearest, in_frame.of_point[x] / in_frame.unit);
        }
    }
    return farthest;
}

double SlidingQuads::Gaps::mean_farthest() const {
    double sum = 0;
    for (const FrameDistances& in_frame : distances_) {
        double farthest = 0;
        for (const double distance : in_frame.of_quad) farthest = std::max(farthest, distance);
        for (const double distance : in_frame.of_point) farthest = std::max(farthest, distance);
        sum += farthest / in_frame.unit;
    }
    return sum / static_cast<double>(distances_.size());
}

std::vector<int> SlidingQuads::Gaps::quads_beyond(double distance) const {
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

std::vector<int> SlidingQuads::Gaps::farthest_quads() const {
    std::vector<int> quads;
    for (const FrameDistances& in_frame : distances_) {
        const auto quad = std::max_element(in_frame.of_quad.begin(), in_frame.of_quad.end());
        const auto point = std::max_element(in_frame.of_point.begin(), in_frame.of_point.end());
        quads.push_back(*quad >= *point ? static_cast<int>(quad - in_frame.of_quad.begin())
                                        : in_frame.nearest[at(point - in_frame.of_point.begin())]);
    }
    sort_unique(quads);
    return quads;
}

SlidingQuads::Gaps::Surroundings SlidingQuads::Gaps::surroundings(
    const std::vector<int>& vertices) const {
    Surroundings around;
    for (const int v : vertices) {
        for (const int c : sliding_.corners_of(v)) around.quads.push_back(c / 4);
    }
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
    double misfit = 0;
    for (std::size_t f = 0; f < distances_.size(); ++f) {
        const FrameDistances& in_frame = distances_[f];
        std::vector<int>& points = around.points.emplace_back();
        double farthest = 0;
        for (const int q : around.quads) {
            farthest = std::max(farthest, in_frame.of_quad[at(q)]);
            for (const int x : in_frame.points_of[at(q)]) {
                points.push_back(x);
                farthest = std::max(farthest, in_frame.of_point[at(x)]);
            }
        }
        order.emplace_back(-farthest / in_frame.unit, f);
        misfit += misfit_of(square(farthest / in_frame.unit));
    }
    std::sort(order.begin(), order.end());
    for (const auto& [negative, f] : order) around.frames.push_back(f);
    around.compared = std::min(compared_frames, around.frames.size());
    // The farthest first: most places that are no better show it there.
    for (std::size_t i = 0; i < around.compared; ++i) {
        const std::size_t f = around.frames[i];
        const std::vector<double>& of_point = distances_[f].of_point;
        std::sort(around.points[f].begin(), around.points[f].end(), [&](int x, int y) {
            return of_point[at(x)] != of_point[at(y)] ? of_point[at(x)] > of_point[at(y)] : x < y;
        });
    }
    around.cost = shape_cost(around) + misfit;
    const FrameDistances& worst = distances_[around.frames.front()];
    std::sort(around.quads.begin(), around.quads.end(), [&](int q, int r) {
        const double of_q = worst.of_quad[at(q)];
        const double of_r = worst.of_quad[at(r)];
        return of_q != of_r ? of_q > of_r : q < r;
    });
    return around;
}

double SlidingQuads::Gaps::rough_cost(const Surroundings& around, double enough) const {
    const double shape = shape_cost(around);
    double misfit = 0;
    for (std::size_t i = 0; i < around.compared; ++i) {
        const double left = enough - shape - misfit;
        if (left <= 0) break;
        const std::size_t f = around.frames[i];
        const double squared_unit = square(distances_[f].unit);
        const double too_far =
            left < infinity ? squared_unit * squared_distance_with(left) : infinity;
        misfit += misfit_of(squared_distance(around, f, too_far) / squared_unit);
    }
    return shape + misfit;
}

bool SlidingQuads::Gaps::take_best(Surroundings& around, const std::function<bool()>& move_to_best,
                                   const std::function<void()>& put_back, const Context& context) {
    const int most_attempts = every_frame_counts_ ? 3 : 1;
    for (int attempt = 0; attempt < most_attempts; ++attempt) {
        const bool is_moved = move_to_best();
        const Verdict verdict =
            is_moved ? take_if_better(around, context) : Verdict::no_frame_helps;
        if (verdict == Verdict::taken) return true;
        put_back();
        if (verdict == Verdict::no_frame_helps) break;
    }
    return false;
}

/// Looks again at what has changed, and keeps what it sees where that is better. Where it is not,
/// `around` gets the farthest of the frames seen beside to compare places in.
SlidingQuads::Gaps::Verdict SlidingQuads::Gaps::take_if_better(Surroundings& around,
                                                               const Context& context) {
    // Most places that are no better show it in the frames that come first.
    constexpr std::size_t frames_together = 16;
    constexpr std::size_t frames_of_thread = 4;
    const double shape = shape_cost(around);
    double misfit = 0;
    std::vector<Look> seen;
    const auto of = [&](std::size_t i) {
        return seen[i].farthest / square(distances_[around.frames[i]].unit);
    };
    const auto compare_in_worst = [&] {
        std::size_t worst = around.compared;
        for (std::size_t i = worst; i < seen.size(); ++i) {
            if (of(i) > of(worst)) worst = i;
        }
        if (worst >= seen.size()) return Verdict::no_frame_helps;
        std::swap(around.frames[worst], around.frames[around.compared]);
        ++around.compared;
        return Verdict::needs_a_frame;
    };
    while (seen.size() < distances_.size()) {
        if (shape + misfit >= around.cost) break;
        const std::size_t first = seen.size();
        seen.resize(std::min(distances_.size(), first + frames_together));
        parallel_for(seen.size() - first, frames_of_thread, context,
                     [&](std::size_t begin, std::size_t end) {
                         for (std::size_t i = first + begin; i < first + end; ++i) {
                             seen[i] = look(around, around.frames[i]);
                         }
                     });
        for (std::size_t i = first; i < seen.size(); ++i) {
            misfit += misfit_of(of(i));
        }
    }
    if (shape + misfit >= around.cost) return compare_in_worst();
    for (std::size_t i = 0; i < seen.size(); ++i) keep(around, around.frames[i], seen[i]);
    return Verdict::taken;
}

/// What the shape of the quads that change counts beside their distances from the input.
double SlidingQuads::Gaps::shape_cost(const Surroundings& around) const {
    double sum = 0;
    for (const Frame& frame : sliding_.shaped()) {
        // The patch begins with the quads that change, in an order that no distance decides.
        for (std::size_t i = 0; i < around.quads.size(); ++i) {
            const QuadCorners corners = sliding_.corners_in(frame, around.patch[i]);
            sum += frame.weight * quad_cost(corners, relaxing_barrier);
        }
    }
    return shape_weight_ * sum / static_cast<double>(sliding_.shaped().size());
}

SlidingQuads::Gaps::Look SlidingQuads::Gaps::look(const Surroundings& around, std::size_t f) const {
    Look seen;
    for (const int q : around.quads) {
        seen.of_quad.push_back(squared_distance_of(q, f));
        seen.farthest = std::max(seen.farthest, seen.of_quad.back());
    }
    for (const int x : around.points[f]) {
        seen.of_point.push_back(nearest_in(around.patch, x, f, distances_[f].squared_near));
        seen.farthest = std::max(seen.farthest, seen.of_point.back().first);
    }
    return seen;
}

void SlidingQuads::Gaps::keep(const Surroundings& around, std::size_t f, const Look& seen) {
    FrameDistances& in_frame = distances_[f];
    for (std::size_t i = 0; i < around.quads.size(); ++i) {
        in_frame.of_quad[at(around.quads[i])] = std::sqrt(seen.of_quad[i]);
        in_frame.points_of[at(around.quads[i])].clear();
    }
    for (std::size_t i = 0; i < around.points[f].size(); ++i) {
        const int x = around.points[f][i];
        const auto [squared, q] = seen.of_point[i];
        in_frame.nearest[at(x)] = q;
        in_frame.points_of[at(q)].push_back(x);
        in_frame.of_point[at(x)] = std::sqrt(squared);
    }
}

/// Gives every side to the first quad that has it.
void SlidingQuads::Gaps::choose_sides() {
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

void SlidingQuads::Gaps::look_at_quads(std::size_t f, const Context& context) {
    FrameDistances& in_frame = distances_[f];
    const int quads = static_cast<int>(sliding_.quads_.Q.rows());
    in_frame.points_of.resize(at(quads));
    for (int q = 0; q < quads; ++q) {
        if (q % 4096 == 0) context.check_cancelled();
        in_frame.of_quad.push_back(std::sqrt(squared_distance_of(q, f)));
    }
}

/// Looks at the points that have not been looked at in frame `f`.
void SlidingQuads::Gaps::look_at_points(std::size_t f, const Context& context) {
    const Frame& frame = sliding_.frames_[f];
    FrameDistances& in_frame = distances_[f];
    const ClosestPoints quads(frame.vertices, cut_quads(sliding_.quads_.Q, frame.vertices));
    int hint = -1;
    for (std::size_t x = in_frame.of_point.size(); x < points_.size(); ++x) {
        if (x % 4096 == 0) context.check_cancelled();
        const Vector3 point = points_[x].position(frame.input);
        const ClosestPoint closest =
            every_frame_counts_ ? quads.find_unless_near(in_frame.squared_near, point, hint)
                                : quads.find(point, hint);
        hint = closest.point.triangle;
        in_frame.nearest.push_back(hint / 2);
        in_frame.points_of[at(hint / 2)].push_back(static_cast<int>(x));
        in_frame.of_point.push_back(std::sqrt(closest.squared_distance));
    }
}

/// Squared distance of point `x` to the nearest of `quads`, or to one that is not farther than
/// `enough`, and that quad.
std::pair<double, int> SlidingQuads::Gaps::nearest_in(const std::vector<int>& quads, int x,
                                                      std::size_t f, double enough) const {
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
double SlidingQuads::Gaps::squared_distance(const Surroundings& around, std::size_t f,
                                            double too_far) const {
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

/// Largest squared distance of points of a triangle to the input, or `known` where none is much
/// farther than that. A point is no farther than another one and the way between the two.
double SlidingQuads::Gaps::squared_distance_inside(const std::array<Vector3, 3>& corners,
                                                   double known, const Frame& frame,
                                                   int hint) const {
    const double tolerance = told_apart_ * frame.mean_edge;
    const Vector3 middle = (corners[0] + corners[1] + corners[2]) / 3;
    double radius = 0;
    for (const Vector3& corner : corners) radius = std::max(radius, (corner - middle).norm());
    const double enough = std::sqrt(known) + tolerance - radius;
    const double squared_enough = enough > 0 ? square(enough) : -1;
    const ClosestPoint found = frame.surface->find_unless_near(squared_enough, middle, hint);
    if (found.squared_distance <= squared_enough) return known;
    double farthest = std::max(known, found.squared_distance);
    if (radius <= tolerance) return farthest;
    const std::array<Vector3, 3> halves = {(corners[1] + corners[2]) / 2,
                                           (corners[2] + corners[0]) / 2,
                                           (corners[0] + corners[1]) / 2};
    for (const auto& part : {halves,
                             std::array{corners[0], halves[2], halves[1]},
                             {corners[1], halves[0], halves[2]},
                             {corners[2], halves[1], halves[0]}}) {
        farthest = std::max(farthest,
                            squared_distance_inside(part, farthest, frame, found.point.triangle));
    }
    return farthest;
}

/// Largest squared distance of points of a quad to the input: on the sides that are its own, on
/// the shorter diagonal and inside the two triangles; on more of them where one is not near. Where
/// all frames count, whatever is far inside, see `densely_sampled`. What is near counts as if it
/// just were.
double SlidingQuads::Gaps::squared_distance_of(int quad, std::size_t f) const {
    const Frame& frame = sliding_.frames_[f];
    const QuadCorners p = sliding_.corners_in(frame, quad);
    const std::size_t k = end_of_cut(p);
    double farthest = distances_[f].squared_near;
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
    const auto at_middle = [&](std::size_t side) { return sliding_.hints_[at(5 * quad) + side]; };
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
    const bool is_far = is_line_far || is_first_far || is_second_far;
    if (is_far) ask_on_lines({0.125, 0.375, 0.625, 0.875});
    if (!every_frame_counts_ || (!is_far && longest_line(p) <= densely_sampled * frame.mean_edge)) {
        return farthest;
    }
    const double worth_telling = square(worth_a_closer_look * distances_[f].unit);
    double inside = std::max(farthest, worth_telling);
    for (const auto& corners :
         {std::array{p[k], p[k + 1], p[k + 2]}, {p[k], p[k + 2], p[(k + 3) % 4]}}) {
        inside = std::max(inside, squared_distance_inside(corners, inside, frame, at_middle(4)));
    }
    return inside > worth_telling ? inside : farthest;
}

}  // namespace kinequad
