#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "kinequad/core/context.h"
#include "kinequad/extract/quad_mesh.h"
#include "kinequad/mesh/closest_points.h"
#include "kinequad/mesh/intrinsic_metric.h"
#include "kinequad/mesh/line_walk.h"
#include "kinequad/relax/quad_cost.h"

namespace kinequad {

/// When a quad counts as badly shaped while its vertices slide.
inline constexpr FoldBarrier relaxing_barrier;

/// Weight of the squared lengths of edges, in mean lengths, beside the cost of the quads: keeps
/// rows evenly apart.
inline constexpr double spacing_weight = 0.1;

/// Length beyond which passes do not make the longest edge at a vertex longer in any frame with a
/// weight, in mean lengths.
inline constexpr double most_stretch = 3;

/// Length below which no move makes the shortest edge at a vertex shorter in the first reference,
/// in mean lengths.
inline constexpr double least_edge_share = 0.1;

/// Distances between quads and input below this are near, in mean lengths of the quads' edges.
inline constexpr double near_share = 0.15;

/// The same where distances need not be known as well.
inline constexpr double roughly_near_share = 0.2;

/// A frame of the input that is looked at, and how much the shape of quads counts there: where it
/// has no weight, their distances from the input do alone.
struct SampledFrame {
    Positions input;  ///< n x 3
    double weight = 1;
};

/// How `close_gaps` goes about it.
struct GapOptions {
    /// Quads and input are brought together where they are farther apart than most of this, in mean
    /// lengths of the quads' edges.
    double limit = 0.45;
    /// Whether each of many frames is to be close. What is far then counts by its sixteenth power,
    /// not its eighth, and is looked at more closely: inside quads and, with more points, on the
    /// input; and a place that turns out no better in all frames is looked for again. In turn,
    /// distances below `roughly_near_share`, not `near_share`, are not told apart, nor, at the
    /// first look, which of several quads as near as that is the nearest.
    bool every_frame_counts = false;
    /// Whether patches move as one where no vertex alone brings the two closer.
    bool drags_patches = false;
    /// What the shape of quads, mean over the frames with a weight, counts beside the sum of the
    /// powers of the distances, in limits, over all frames.
    double shape_weight = 3;
    /// Length beyond which no move makes the longest edge at a vertex longer in any frame with a
    /// weight, in mean lengths.
    double most_stretch = kinequad::most_stretch;
    /// Whether of all quads that are far those alone are looked at that are the farthest in some
    /// frame, and again until none of these comes closer, or after 32 rounds: more closely than
    /// others, with patches moving in more ways and vertices farther around taking part.
    bool only_farthest = false;
};

/// Distances between quads and input, in units of the limit that was asked for.
struct GapsLeft {
    std::vector<double> at_quads;  ///< q: at the quad, at most over all frames
    double mean_farthest = 0;      ///< the largest in a frame, mean over all frames
};

/// A quad mesh whose vertices slide over the surface, watched in several frames at once. The first
/// frames are the references: folds and distances are looked at in these. Vertices on the boundary
/// stay; those that `cover_extremities` has put in place do until `release`.
class SlidingQuads {
public:
    /// `quads` that `verify_quad_mesh` finds valid; `F` m x 3 triangles of the input; the first
    /// `reference_count` of `frames`, at least one, are references; frames without weight come
    /// last. `topology`, `metric` and `F` have to outlive this.
    SlidingQuads(const QuadMesh& quads, const Topology& topology, const IntrinsicMetric& metric,
                 const Triangles& F, std::vector<SampledFrame> frames, int reference_count);

    /// Ties vertices on the edges `edges` of the surface to them: they move along lines of these,
    /// those at ends of lines stay.
    void let_slide(const std::vector<int>& edges);

    /// What the quads around a vertex should become.
    enum class Aim {
        squares,       ///< of equal sides too: evens out a map that is far from the surface
        right_angles,  ///< the least of the cost itself, once quads are close to squares
    };

    /// Moves every vertex once towards the `aim` of the quads around it, where that lowers their
    /// cost and `spacing_weight` times the squares of their sides, over all frames. Returns the
    /// number of moves.
    ///
    /// Only quads that are farther than half of `distance_limit` (units of the input) from the
    /// input in a reference as the pass begins are watched: no move takes one of these farther than
    /// the limit, or than the farthest of them around the vertex is already.
    int relax_pass(Aim aim, double distance_limit, const Context& context);

    /// Tries moves of the vertices up to `reach` quads around every quad whose scaled Jacobian in
    /// a reference is below `safe_jacobian`, and keeps what opens it towards that. Returns the
    /// number of quads still folded there.
    int unfold_pass(double safe_jacobian, int reach, const Context& context);

    /// Distance between the two surfaces at every quad (q), at most over the references, in units
    /// of the input: seen from points of the quad, and from the vertices of the input that are
    /// closest to it. Where these touch another limb in the reference, the distance in the frame
    /// that parts the two counts.
    std::vector<double> distances(const Context& context) const;

    /// Keeps the corners of a quad where they are until `release`.
    void hold(int quad);

    /// Where all vertices are, and which stay there.
    struct State {
        std::vector<SurfacePoint> vertex;
        std::vector<char> is_pinned;
    };
    State state() const { return {quads_.vertex, is_pinned_}; }

    /// Puts all vertices back to where they were.
    void restore(const State& state);

    /// The same for the corners of the quads `region` alone.
    void restore(const State& state, const std::vector<int>& region);

    /// The quads with a corner that is not where it was, in regions that share no such corner.
    std::vector<std::vector<int>> regions_moved_since(const State& state) const;

    /// The quads up to `reach` quads around quad `quad`, which comes with them.
    std::vector<int> quads_around(int quad, int reach) const;

    /// Whether a quad is folded in a reference.
    bool is_folded(int quad) const { return least_jacobian_of(quad) <= 0; }

    /// Sets free what `cover_extremities` has put in place and `hold` has kept; some tips of lines
    /// keep their vertices.
    void release();

    /// Puts quad vertices onto vertices of the input that are farther than `limit` (units of the
    /// input) from the quads in a reference, the farthest first, at most one a quad: none on the
    /// boundary but on lines, and none where a quad would get too slanted or an edge too long. They
    /// stay there until `release`. Returns the number of vertices put in place.
    int cover_extremities(double limit, const Context& context);

    /// Tries moves of the vertices up to `reach` quads around quads whose inside or edges leave the
    /// surface by more than `limit` (units of the input) in a reference, as where they bridge a
    /// crease, and keeps what brings them closer.
    void hug_surface(double limit, int reach, const Context& context);

    /// Brings quads and input together in all frames: vertices where the two are far apart search
    /// for places that are closer in all frames and hardly cost angles; where that is not enough,
    /// those around them may go along. Sets free what is held. Returns how far apart the two are
    /// then.
    GapsLeft close_gaps(const GapOptions& options, const Context& context);

    /// The largest distance between quads and input in a frame, mean over all frames, in mean
    /// lengths of the quads' edges; distances below `near_share` count as that.
    double mean_farthest(const Context& context);

    /// The cost of all quads over the frames with a weight, without that of spacing.
    double shape_cost() const;

    /// Number of frames for each that has a weight.
    double frames_per_shaped() const {
        return static_cast<double>(frames_.size()) / static_cast<double>(shaped_frames_);
    }

    /// Mean length of the quads' edges in the first reference, in units of the input.
    double mean_edge_length() const { return mean_edge_length(frames_[0]); }

    const QuadMesh& quads() const { return quads_; }

private:
    struct Range {
        const int* first;
        const int* last;
        const int* begin() const { return first; }
        const int* end() const { return last; }
    };
    /// A frame and the quad vertices in it.
    struct Frame {
        Positions input;
        Positions vertices;
        double weight;
        double mean_edge;                      ///< of the quads, when they began to slide
        std::optional<ClosestPoints> surface;  ///< of a reference, or once gaps are looked for
    };
    /// A pose in which folds and distances are looked at: the first frames, with the input there.
    struct Reference {
        const Frame& frame;
        const ClosestPoints& surface;
    };

    class Gaps;
    class Patch;
    /// Steps of a search for a better place.
    struct Steps {
        int directions = 12;
        std::vector<double> lengths = {0.9, 0.5, 0.25, 0.12, 0.06, 0.03};  ///< in sides of the quad
        bool go_on = false;  ///< each length around the best place so far, not around the first
    };
    /// A vertex of the input and the quad that is closest to it.
    struct Far {
        double distance;
        int vertex;
        int quad;
    };
    int frame_that_parts(int x, const SurfacePoint& point, const Triangles& cut) const;
    std::vector<Far> input_farther_than(double distance, const Reference& reference,
                                        const Context& context) const;

    /// The frames with a weight.
    std::span<const Frame> shaped() const { return std::span(frames_).first(shaped_frames_); }
    Range corners_of(int v) const;
    int neighbour(int corner, int k) const;
    QuadCorners corners_in(const Frame& frame, int quad) const;
    double cost_around(int v, const FoldBarrier& barrier) const;
    double spacing_cost(int v) const;
    double relaxing_cost(int v) const;
    double least_jacobian_around(int v) const;
    Eigen::Matrix<double, 3, 2> embedding(int t, const Positions& X) const;
    Vector2 move_to_squares(int v) const;
    Vector2 move_to_right_angles(int v) const;
    double least_jacobian_of(int quad) const;
    SurfacePoint walked(int v, const SurfacePoint& start, const Vector2& move) const;
    double first_side_length(int v) const;
    double shortest_edge(int v) const;
    double least_edge_at(int v) const;
    double longest_edge(int v, const Frame& frame) const;
    double longest_edge(int v) const;
    double mean_edge_length(const Frame& frame) const;
    double watched_distance(int v) const;
    bool improve(int v, Aim aim, double distance_limit);
    bool search_around(int v, const Steps& steps, const std::function<double(double)>& cost);
    bool close_gaps_at(int v, Gaps& gaps, const Context& context);
    bool drag(int v, const std::vector<double>& following_shares, Gaps& gaps,
              const Context& context);
    bool move_onto(int v, const SurfacePoint& goal);
    int nearest_in_all_frames(int x) const;
    int cover_extremities_in(const Reference& reference, double limit, const Context& context);
    std::vector<int> vertices_around(int quad, int reach) const;
    double distance_of(int quad, double least_told = 0) const;
    bool is_near(int quad);
    void place(int v, const SurfacePoint& point);
    void find_surfaces(const Context& context);
    void link_corners();
    void pin_boundary();

    QuadMesh quads_;
    const Topology& topology_;
    const IntrinsicMetric& metric_;
    const Triangles& F_;
    std::vector<Frame> frames_;
    std::size_t shaped_frames_ = 0;  ///< number of `shaped` frames
    std::vector<Reference> references_;
    std::vector<int>
        corner_start_;  ///< corners of vertex v: corner_[corner_start_[v] .. corner_start_[v+1]]
    std::vector<int> corner_;  ///< corner c of quad q as 4q + c
    std::vector<char> is_pinned_;
    std::vector<char> stays_;   ///< v: on the boundary, or told to
    std::vector<char> slides_;  ///< v: on a line, along which it may move
    std::optional<LineWalk> walk_;
    std::vector<char> is_watched_;  ///< q: see `relax_pass`
    /// 5q + k: a triangle near the middle of side k of quad q when a pass last began, or for k = 4
    /// near its own; speeds searches up and changes no result.
    std::vector<int> hints_;
};

}  // namespace kinequad
