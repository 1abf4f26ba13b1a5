#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "kinequad/relax/sliding_quads.h"

namespace kinequad {

/// The distances between quads and input in all frames, kept up to date while vertices move. In
/// every frame the unit is the limit of the options.
class SlidingQuads::Gaps {
public:
    Gaps(const SlidingQuads& quads, const GapOptions& options, const Context& context);

    /// The distance at every quad (q), at most over the frames, in units.
    std::vector<double> at_quads() const;

    /// The largest distance in a frame, mean over the frames, in units.
    double mean_farthest() const;

    /// The quads farther away than `distance` units in some frame, the farthest first.
    std::vector<int> quads_beyond(double distance) const;

    /// The quads at the largest distance of some frame, by number.
    std::vector<int> farthest_quads() const;

    /// What changes as some vertices move, and what is near.
    struct Surroundings {
        std::vector<int> quads;                ///< that change, the farthest first
        std::vector<int> patch;                ///< these, by number, then the ones around them
        std::vector<std::vector<int>> points;  ///< f: of the input, nearest to those that change
        std::vector<std::size_t> frames;       ///< the one with the largest distance first
        std::size_t compared = 0;              ///< number of the first of them that places are
                                               ///< compared in
        double cost = 0;                       ///< see below, before anything moves
    };
    Surroundings surroundings(const std::vector<int>& vertices) const;

    /// What is to become less: the sum of the powers of the largest distances, see `GapOptions`,
    /// and what the shape of the quads costs, but with distances in the frames alone that `around`
    /// has for comparing places. Does not add up beyond `enough`.
    double rough_cost(const Surroundings& around, double enough) const;

    /// Length that no move makes the longest edge at a vertex longer than, where it is `longest`.
    double longest_allowed(double longest) const { return std::max(longest, most_stretch_); }

    /// Moves to the best place by `rough_cost`, if there is one, with `move_to_best`, which says
    /// whether there is, and looks again at what has changed. Where the cost over all frames is
    /// less than it was before anything moved, keeps what it sees and returns true. Where it is
    /// not, the first few frames may be no measure of many: where every frame counts, another place
    /// is looked for, compared in one more frame, twice at most. `put_back` undoes a move.
    bool take_best(Surroundings& around, const std::function<bool()>& move_to_best,
                   const std::function<void()>& put_back, const Context& context);

private:
    /// A point of the input that is looked at, in the triangle of the vertices `a`, `b` and `c`; a
    /// vertex where all are the same, a point of an edge where `c` is `a`.
    struct InputPoint {
        int a;
        int b;
        int c;
        double share_of_b;
        double share_of_c;

        Vector3 position(const Positions& X) const {
            return ((1 - share_of_b - share_of_c) * X.row(a) + share_of_b * X.row(b) +
                    share_of_c * X.row(c))
                .transpose();
        }
    };

    /// Distances in one frame, in units of the input.
    struct FrameDistances {
        double unit = 1;
        double squared_near = 0;                  ///< what is not farther counts as this
        std::vector<double> of_quad;              ///< q: from the quad to the input
        std::vector<double> of_point;             ///< x: from the point to the quads
        std::vector<int> nearest;                 ///< x: the quad it is nearest to
        std::vector<std::vector<int>> points_of;  ///< q: the points nearest to it
    };

    /// What is seen of surroundings in one frame, in squared units of the input.
    struct Look {
        std::vector<double> of_quad;                   ///< as its quads
        std::vector<std::pair<double, int>> of_point;  ///< as its points: also the nearest quad
        double farthest = 0;
    };

    /// What `take_if_better` comes to.
    enum class Verdict {
        taken,           ///< better, and known now
        needs_a_frame,   ///< no better; another place may be: they are compared in one more frame
        no_frame_helps,  ///< no better, as places have been compared in all frames that show it
    };

    Verdict take_if_better(Surroundings& around, const Context& context);
    Look look(const Surroundings& around, std::size_t f) const;
    void keep(const Surroundings& around, std::size_t f, const Look& seen);
    double misfit_of(double squared) const;
    double squared_distance_with(double misfit) const;
    double shape_cost(const Surroundings& around) const;
    void choose_points();
    void choose_more_points(const GapOptions& options);
    std::vector<char> vertices_beyond(double distance) const;
    void choose_points_on_edges(double longest, const std::vector<char>& is_wanted);
    void choose_points_inside(const std::vector<char>& is_wanted);
    void choose_sides();
    void look_at_quads(std::size_t f, const Context& context);
    void look_at_points(std::size_t f, const Context& context);
    std::pair<double, int> nearest_in(const std::vector<int>& quads, int x, std::size_t f,
                                      double enough) const;
    double squared_distance(const Surroundings& around, std::size_t f, double too_far) const;
    double squared_distance_of(int quad, std::size_t f) const;
    double squared_distance_inside(const std::array<Vector3, 3>& corners, double known,
                                   const Frame& frame, int hint) const;

    const SlidingQuads& sliding_;
    double shape_weight_;
    double most_stretch_;
    double told_apart_;               ///< in mean lengths of edges
    bool every_frame_counts_;         ///< see `GapOptions`
    int most_parts_ = 0;              ///< of an edge of the input, between points
    bool has_close_points_ = true;    ///< whether points on all edges are close to one another
    std::vector<InputPoint> points_;  ///< of the input
    std::vector<char> owns_side_;     ///< corner c: whether the side that begins there is looked at
    std::vector<FrameDistances> distances_;  ///< f
};

}  // namespace kinequad
