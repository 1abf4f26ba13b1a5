// What relaxation does to quads that fold, leave the surface or miss its tips: vertices search
// around.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "kinequad/core/index.h"
#include "kinequad/core/sort_unique.h"
#include "kinequad/relax/sliding_quads.h"

namespace kinequad {
namespace {

/// A quad that covers an extremity may become this slanted, but no more.
constexpr double least_covering_jacobian = 0.15;

}  // namespace

/// Moves vertex `v` to where `cost` is least among places around it, if that is less than here, and
/// returns whether it is. `cost` is told the least so far, and may stop adding up once it has
/// reached that.
bool SlidingQuads::search_around(int v, const Steps& steps,
                                 const std::function<double(double)>& cost) {
    const double size = first_side_length(v);
    const SurfacePoint before = quads_.vertex[at(v)];
    SurfacePoint best = before;
    bool is_moved = false;
    const double least_edge = least_edge_at(v);
    double least = cost(std::numeric_limits<double>::infinity());
    for (const double length : steps.lengths) {
        const SurfacePoint start = steps.go_on ? best : before;
        for (int i = 0; i < steps.directions; ++i) {
            const double angle = 2 * std::numbers::pi * (i + 5 * length) / steps.directions;
            const Vector2 step = length * size * Vector2(std::cos(angle), std::sin(angle));
            place(v, walked(v, start, step));
            const double value = shortest_edge(v) >= least_edge ? cost(least) : least;
            if (value < least) {
                least = value;
                best = quads_.vertex[at(v)];
                is_moved = true;
            }
        }
    }
    place(v, best);
    return is_moved;
}

/// The corners of a quad and all vertices up to `reach` quads farther on, in ascending order.
std::vector<int> SlidingQuads::vertices_around(int quad, int reach) const {
    std::vector<int> around = {quads_.Q(quad, 0), quads_.Q(quad, 1), quads_.Q(quad, 2),
                               quads_.Q(quad, 3)};
    for (int ring = 0; ring < reach; ++ring) {
        std::vector<int> wider = around;
        for (const int v : around) {
            for (const int c : corners_of(v)) {
                wider.insert(wider.end(), {neighbour(c, 1), neighbour(c, 2), neighbour(c, 3)});
            }
        }
        sort_unique(wider);
        around = std::move(wider);
    }
    std::sort(around.begin(), around.end());
    return around;
}

std::vector<int> SlidingQuads::quads_around(int quad, int reach) const {
    std::vector<int> around = {quad};
    if (reach > 0) {
        for (const int v : vertices_around(quad, reach - 1)) {
            for (const int c : corners_of(v)) around.push_back(c / 4);
        }
    }
    sort_unique(around);
    return around;
}

int SlidingQuads::unfold_pass(double safe_jacobian, int reach, const Context& context) {
    const FoldBarrier barrier{safe_jacobian, 100};
    // The references decide; the others only choose among what unfolds it alike.
    const auto cost = [&](int v, double most) {
        const double weight =
            static_cast<double>(frames_.size()) / static_cast<double>(references_.size());
        double sum = 0;
        for (const int c : corners_of(v)) {
            for (const Reference& reference : references_) {
                sum += weight * quad_cost(corners_in(reference.frame, c / 4), barrier);
            }
        }
        return sum < most ? sum + 0.1 * cost_around(v, relaxing_barrier) : sum;
    };
    int folded = 0;
    for (int q = 0; q < static_cast<int>(quads_.Q.rows()); ++q) {
        if (least_jacobian_of(q) >= safe_jacobian) continue;
        context.check_cancelled();
        for (const int v : vertices_around(q, reach)) {
            if (is_pinned_[at(v)] == 0)
                search_around(v, {}, [&](double most) { return cost(v, most); });
        }
        folded += is_folded(q) ? 1 : 0;
    }
    return folded;
}

/// How far a quad is from the input, at most, in the references: in its middle and that of its
/// edges, and where these are not near, halfway on to the corners too. Distances below
/// `least_told`, in mean lengths of the quads' edges, count as that.
double SlidingQuads::distance_of(int quad, double least_told) const {
    double farthest = 0;
    for (const Reference& reference : references_) {
        const QuadCorners p = corners_in(reference.frame, quad);
        int hint = hints_[at(5 * quad + 4)];
        const double least = least_told * reference.frame.mean_edge;
        double squared = least * least;
        const auto ask = [&](const Vector3& point) {
            const ClosestPoint found = reference.surface.find_unless_near(squared, point, hint);
            squared = std::max(squared, found.squared_distance);
            hint = found.point.triangle;
        };
        const Vector3 middle = (p[0] + p[1] + p[2] + p[3]) / 4;
        ask(middle);
        for (int k = 0; k < 4; ++k) {
            hint = hints_[at(5 * quad + k)];
            ask((p[at(k)] + p[(at(k) + 1) % 4]) / 2);
        }
        const double near_distance = near_share * reference.frame.mean_edge;
        if (squared > near_distance * near_distance) {
            for (std::size_t k = 0; k < 4; ++k) {
                const Vector3& next = p[(k + 1) % 4];
                for (const Vector3& point :
                     {Vector3((middle + p[k]) / 2), Vector3((3 * p[k] + next) / 4),
                      Vector3((p[k] + 3 * next) / 4)}) {
                    ask(point);
                }
            }
        }
        farthest = std::max(farthest, squared);
    }
    return std::sqrt(farthest);
}

void SlidingQuads::hug_surface(double limit, int reach, const Context& context) {
    constexpr double distance_weight = 40;
    const FoldBarrier barrier{0.2, 100};
    for (int q = 0; q < static_cast<int>(quads_.Q.rows()); ++q) {
        context.check_cancelled();
        if (distance_of(q) <= limit) continue;
        for (const int v : vertices_around(q, reach)) {
            if (is_pinned_[at(v)]) continue;
            search_around(v, {}, [&](double most) {
                double sum = cost_around(v, barrier) / static_cast<double>(frames_.size());
                for (const int c : corners_of(v)) {
                    if (sum >= most) break;
                    const double excess = std::max(0.0, distance_of(c / 4) / limit - 0.5);
                    sum += distance_weight * excess * excess;
                }
                return sum;
            });
        }
    }
}

/// Puts vertex `v` on `goal` and lets its neighbours give way; takes all back where a quad gets too
/// slanted.
bool SlidingQuads::move_onto(int v, const SurfacePoint& goal) {
    const FoldBarrier barrier{0.25, 100};
    std::vector<std::pair<int, SurfacePoint>> before = {{v, quads_.vertex[at(v)]}};
    for (const int c : corners_of(v)) {
        for (const int k : {1, 2})
            before.emplace_back(neighbour(c, k), quads_.vertex[at(neighbour(c, k))]);
    }
    double least_before = 1;
    for (const auto& [w, point] : before)
        least_before = std::min(least_before, least_jacobian_around(w));
    const double enough = std::min(least_before, least_covering_jacobian);
    const auto least_around = [&] {
        double least = 1;
        for (const auto& [w, point] : before) least = std::min(least, least_jacobian_around(w));
        return least;
    };
    const double longest = longest_edge(v);
    place(v, goal);
    // What is near in a reference may lie on another limb, as other frames tell.
    double near = 1;
    for (const Reference& reference : references_) {
        near = std::max(near, longest_edge(v, reference.frame));
    }
    if (longest_edge(v) > std::max(longest, most_stretch * near)) {
        place(v, before.front().second);
        return false;
    }
    for (int round = 0; round < 2 && least_around() < enough; ++round) {
        for (const auto& moved : before) {
            const int w = moved.first;
            if (w == v || is_pinned_[at(w)]) continue;
            search_around(w, {}, [&](double) { return cost_around(w, barrier); });
        }
    }
    if (least_around() >= enough) return true;
    for (const auto& [w, point] : before) place(w, point);
    return false;
}

int SlidingQuads::cover_extremities(double limit, const Context& context) {
    int placed = 0;
    for (const Reference& reference : references_) {
        placed += cover_extremities_in(reference, limit, context);
    }
    return placed;
}

/// The quad vertex whose distance to vertex `x` of the input, squared, is least in the sum over all
/// frames.
int SlidingQuads::nearest_in_all_frames(int x) const {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(quads_.vertex.size()));
    for (const Frame& frame : frames_) {
        sum += (frame.vertices.rowwise() - frame.input.row(x)).rowwise().squaredNorm();
    }
    Eigen::Index nearest = 0;
    sum.minCoeff(&nearest);
    return static_cast<int>(nearest);
}

int SlidingQuads::cover_extremities_in(const Reference& reference, double limit,
                                       const Context& context) {
    std::vector<Far> far = input_farther_than(limit, reference, context);
    std::sort(far.begin(), far.end(), [](const Far& a, const Far& b) {
        return a.distance != b.distance ? a.distance > b.distance : a.vertex < b.vertex;
    });

    const Frame& frame = reference.frame;
    int placed = 0;
    std::vector<char> is_busy(at(static_cast<int>(quads_.Q.rows())), 0);
    for (const Far& f : far) {
        // One extremity a quad at a time: moving its corner changes all distances around.
        if (is_busy[at(f.quad)]) continue;
        std::vector<std::pair<double, int>> corners;
        for (int k = 0; k < 4; ++k) {
            const int v = quads_.Q(f.quad, k);
            corners.emplace_back((frame.vertices.row(v) - frame.input.row(f.vertex)).squaredNorm(),
                                 v);
        }
        std::sort(corners.begin(), corners.end());
        // Where limbs touch, that quad may be on the wrong one.
        corners.emplace_back(0, nearest_in_all_frames(f.vertex));
        const int h = topology_.vertex_half_edge[at(f.vertex)];
        // On a line, where this triangle has no edge of it, a vertex stays on the tip for good.
        // Letting all of those slide, or none, was measured: no better.
        const SurfacePoint extremity{h / 3, Vector3::Unit(h % 3)};
        const bool is_on_line = walk_ && walk_->edge_of(extremity) >= 0;
        if (topology_.is_boundary_vertex(f.vertex) && !is_on_line) continue;
        for (const auto& [distance, v] : corners) {
            // The tip of a line of symmetry is for a vertex of the line, all others for the rest.
            if (is_pinned_[at(v)] || (slides_[at(v)] != 0) != is_on_line) continue;
            if (!move_onto(v, extremity)) continue;
            is_pinned_[at(v)] = 1;
            for (const int c : corners_of(v)) is_busy[at(c / 4)] = 1;
            ++placed;
            break;
        }
    }
    return placed;
}

}  // namespace kinequad
