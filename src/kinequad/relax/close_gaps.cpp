// What relaxation does about the distance between quads and input in all frames.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "kinequad/core/index.h"
#include "kinequad/core/parallel.h"
#include "kinequad/core/sort_unique.h"
#include "kinequad/relax/gaps.h"
#include "kinequad/relax/sliding_quads.h"

namespace kinequad {
namespace {

/// No move takes a scaled Jacobian below this, or below what it is.
constexpr double least_closing_jacobian = 0.1;

/// Vectors in the plane of the columns of `tangents`, in three lengths up to 0.8.
std::vector<Vector3> moves_in_plane(const Eigen::Matrix<double, 3, 2>& tangents) {
    constexpr int directions = 8;
    const Vector3 along = tangents.col(0).normalized();
    const Vector3 across = tangents.col(0).cross(tangents.col(1)).cross(along).normalized();
    std::vector<Vector3> moves;
    for (const double length : {0.8, 0.4, 0.2}) {
        for (int i = 0; i < directions; ++i) {
            const double angle = 2 * std::numbers::pi * i / directions;
            moves.emplace_back(length * (std::cos(angle) * along + std::sin(angle) * across));
        }
    }
    return moves;
}

}  // namespace

/// Moves vertex `v` to where quads and input are closer in all frames, and angles not much worse.
/// Returns whether there is such a place.
bool SlidingQuads::close_gaps_at(int v, Gaps& gaps, const Context& context) {
    static const Steps steps{6, {0.4, 0.16, 0.06}, true};
    Gaps::Surroundings around = gaps.surroundings({v});
    const SurfacePoint before = quads_.vertex[at(v)];
    const double least_jacobian = std::min(least_jacobian_around(v), least_closing_jacobian);
    const double longest = gaps.longest_allowed(longest_edge(v));
    const auto move_to_best = [&] {
        return search_around(v, steps, [&](double least) {
            if (least_jacobian_around(v) < least_jacobian || longest_edge(v) > longest)
                return least;
            return gaps.rough_cost(around, least);
        });
    };
    return gaps.take_best(
        around, move_to_best, [&] { place(v, before); }, context);
}

/// A vertex and the free ones of the quads around it, which go along: where a tip has to be
/// reached, no vertex gets there alone.
class SlidingQuads::Patch {
public:
    Patch(SlidingQuads& quads, int middle)
        : sliding_(quads), middle_(middle), vertices_(vertices_with(quads, middle)) {
        before_ = places();
    }

    const std::vector<int>& vertices() const { return vertices_; }

    std::vector<SurfacePoint> places() const {
        std::vector<SurfacePoint> points;
        points.reserve(vertices_.size());
        for (const int v : vertices_) points.push_back(sliding_.quads_.vertex[at(v)]);
        return points;
    }

    void put(const std::vector<SurfacePoint>& points) {
        for (std::size_t i = 0; i < vertices_.size(); ++i) sliding_.place(vertices_[i], points[i]);
    }

    void put_back() { put(before_); }

    /// Moves the middle by `move` (in space) over the surface as it lies in the pose `X` (n x 3),
    /// from where it was at first, and the rest by `following_share` of it.
    void move(const Vector3& move, const Positions& X, double following_share) {
        for (std::size_t i = 0; i < vertices_.size(); ++i) {
            const auto tangents = sliding_.embedding(before_[i].triangle, X);
            const Vector2 step =
                (tangents.transpose() * tangents).ldlt().solve(tangents.transpose() * move);
            const double share = vertices_[i] == middle_ ? 1 : following_share;
            sliding_.place(vertices_[i],
                           step.allFinite()
                               ? sliding_.walked(vertices_[i], before_[i], share * step)
                               : before_[i]);
        }
    }

    /// Lengths of the shortest edge, as in `shortest_edge`, and of the longest, as in
    /// `longest_edge`, at the vertices.
    std::pair<double, double> extent() const {
        std::pair<double, double> edges = {std::numeric_limits<double>::infinity(), 0};
        for (const int v : vertices_) {
            edges.first = std::min(edges.first, sliding_.shortest_edge(v));
            edges.second = std::max(edges.second, sliding_.longest_edge(v));
        }
        return edges;
    }

private:
    static std::vector<int> vertices_with(const SlidingQuads& quads, int middle) {
        std::vector<int> vertices = {middle};
        for (const int c : quads.corners_of(middle)) {
            for (const int k : {1, 2, 3}) {
                const int v = quads.neighbour(c, k);
                if (quads.is_pinned_[at(v)] == 0) vertices.push_back(v);
            }
        }
        sort_unique(vertices);
        return vertices;
    }

    SlidingQuads& sliding_;
    int middle_;
    std::vector<int> vertices_;
    std::vector<SurfacePoint> before_;
};

/// As `close_gaps_at`, for `v` and the patch around it, which goes along by one of the shares.
bool SlidingQuads::drag(int v, const std::vector<double>& following_shares, Gaps& gaps,
                        const Context& context) {
    Patch patch(*this, v);
    Gaps::Surroundings around = gaps.surroundings(patch.vertices());
    const auto least_jacobian = [&] {
        double least = 1;
        for (const int q : around.quads) least = std::min(least, least_jacobian_of(q));
        return least;
    };
    const double least_allowed = std::min(least_jacobian(), least_closing_jacobian);
    const auto [shortest, longest] = patch.extent();
    const double shortest_allowed = std::min(shortest, least_edge_share * frames_[0].mean_edge);
    const double longest_allowed = gaps.longest_allowed(longest);
    const auto is_allowed = [&] {
        const auto [shortest_now, longest_now] = patch.extent();
        return shortest_now >= shortest_allowed && longest_now <= longest_allowed &&
               least_jacobian() >= least_allowed;
    };

    const Frame& frame = frames_[around.frames.front()];
    const double size = shortest_edge(v) * frame.mean_edge / frames_[0].mean_edge;
    const std::vector<Vector3> moves =
        moves_in_plane(embedding(quads_.vertex[at(v)].triangle, frame.input));
    const auto move_to_best = [&] {
        double least_cost = gaps.rough_cost(around, std::numeric_limits<double>::infinity());
        std::vector<SurfacePoint> best;
        for (const double share : following_shares) {
            for (const Vector3& move : moves) {
                patch.move(size * move, frame.input, share);
                if (!is_allowed()) continue;
                const double cost = gaps.rough_cost(around, least_cost);
                if (cost >= least_cost) continue;
                least_cost = cost;
                best = patch.places();
            }
        }
        if (best.empty()) return false;
        patch.put(best);
        return true;
    };
    return gaps.take_best(
        around, move_to_best, [&] { patch.put_back(); }, context);
}

/// Makes closest points on the input known in all frames.
void SlidingQuads::find_surfaces(const Context& context) {
    parallel_for(frames_.size(), 1, context, [&](std::size_t f, std::size_t) {
        if (!frames_[f].surface) frames_[f].surface.emplace(frames_[f].input, F_);
    });
}

double SlidingQuads::mean_farthest(const Context& context) {
    find_surfaces(context);
    return Gaps(*this, {.limit = 1}, context).mean_farthest();
}

GapsLeft SlidingQuads::close_gaps(const GapOptions& options, const Context& context) {
    const int rounds = options.only_farthest ? 32 : 8;
    constexpr double far_share = 0.8;
    release();
    find_surfaces(context);
    Gaps gaps(*this, options, context);
    const auto far_quads = [&] {
        return options.only_farthest ? gaps.farthest_quads() : gaps.quads_beyond(far_share);
    };
    // Goes over the vertices up to `reach` quads around those that are far, until `is_moved` moves
    // none any more; where one has moved, those up to a quad farther on have another chance.
    const auto go_over = [&](int reach, std::size_t most, const auto& is_moved) {
        std::vector<char> is_settled(quads_.vertex.size(), 0);
        bool is_any_moved = true;
        for (int round = 0; round < rounds && is_any_moved; ++round) {
            is_any_moved = false;
            for (const int q : far_quads()) {
                for (const int v : vertices_around(q, reach)) {
                    if (is_pinned_[at(v)] != 0 || is_settled[at(v)] != 0 || most == 0) continue;
                    context.check_cancelled();
                    --most;
                    is_settled[at(v)] = 1;
                    if (!is_moved(v)) continue;
                    is_any_moved = true;
                    for (const int c : corners_of(v)) {
                        for (const int w : vertices_around(c / 4, 1)) is_settled[at(w)] = 0;
                    }
                }
            }
        }
    };
    // A search costs time: there is one for every other vertex, on average, and a patch is dragged
    // for every sixteenth, or fewer where each has to be looked at in many frames.
    constexpr std::size_t usual_frames = 64;
    const std::size_t patches =
        quads_.vertex.size() / 16 * usual_frames / std::max(usual_frames, frames_.size());
    go_over(1, quads_.vertex.size() / 2, [&](int v) { return close_gaps_at(v, gaps, context); });
    if (options.drags_patches) {
        const auto following_shares =
            options.only_farthest ? std::vector{0.5, 1.0, 0.25, -0.3} : std::vector{0.5};
        go_over(0, patches, [&](int v) {
            if (!drag(v, following_shares, gaps, context)) return false;
            for (const int c : corners_of(v)) {
                for (const int w : vertices_around(c / 4, 0)) {
                    if (is_pinned_[at(w)] == 0) close_gaps_at(w, gaps, context);
                }
            }
            return true;
        });
    }
    // What the few have cost is shared with those around.
    if (options.only_farthest) {
        go_over(3, quads_.vertex.size(), [&](int v) { return close_gaps_at(v, gaps, context); });
    }
    return {gaps.at_quads(), gaps.mean_farthest()};
}

}  // namespace kinequad
