#include "kinequad/relax/sliding_quads.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kinequad/core/index.h"
#include "kinequad/mesh/trace_geodesic.h"

namespace kinequad {
namespace {

/// Moves shorter than this share of the quad's size are not worth a try.
constexpr double least_move = 0.002;
/// Scaled Jacobian below which no move takes a quad in a reference for the sake of other frames.
constexpr double least_kept_jacobian = 0.05;

/// Edges of quads by which two points of the surface that coincide in one frame are apart in
/// another, if they belong to different limbs.
constexpr double most_apart = 2;

}  // namespace

SlidingQuads::SlidingQuads(const QuadMesh& quads, const Topology& topology,
                           const IntrinsicMetric& metric, const Triangles& F,
                           std::vector<SampledFrame> frames, int reference_count)
    : quads_(quads), topology_(topology), metric_(metric), F_(F) {
    link_corners();
    pin_boundary();
    for (SampledFrame& frame : frames) {
        Frame own{std::move(frame.input), {}, frame.weight, 0, std::nullopt};
        own.vertices.resize(static_cast<Eigen::Index>(quads.vertex.size()), 3);
        frames_.push_back(std::move(own));
    }
    for (int v = 0; v < static_cast<int>(quads_.vertex.size()); ++v) place(v, quads_.vertex[at(v)]);
    for (int q = 0; q < static_cast<int>(quads_.Q.rows()); ++q) {
        for (const int k : {0, 1, 2, 3, 0}) {
            hints_.push_back(quads_.vertex[at(quads_.Q(q, k))].triangle);
        }
    }
    for (Frame& frame : frames_) frame.mean_edge = mean_edge_length(frame);
    while (shaped_frames_ < frames_.size() && frames_[shaped_frames_].weight > 0) ++shaped_frames_;
    for (int r = 0; r < reference_count; ++r) {
        Frame& frame = frames_[at(r)];
        references_.push_back({frame, frame.surface.emplace(frame.input, F)});
    }
}

void SlidingQuads::link_corners() {
    const std::size_t count = quads_.vertex.size();
    const int* index = quads_.Q.data();
    const int corners = static_cast<int>(quads_.Q.size());
    corner_start_.assign(count + 1, 0);
    for (int c = 0; c < corners; ++c) ++corner_start_[at(index[c]) + 1];
    for (std::size_t v = 0; v < count; ++v) corner_start_[v + 1] += corner_start_[v];
    corner_.resize(at(corners));
    std::vector<int> next(corner_start_.begin(), corner_start_.end() - 1);
    for (int c = 0; c < corners; ++c) corner_[at(next[at(index[c])]++)] = c;
}

void SlidingQuads::pin_boundary() {
    // A vertex is interior where every edge at it is left by one quad and reached by another.
    is_pinned_.assign(quads_.vertex.size(), 0);
    std::vector<int> balance(quads_.vertex.size(), 0);
    for (int v = 0; v < static_cast<int>(quads_.vertex.size()); ++v) {
        for (const int c : corners_of(v)) {
            balance[at(neighbour(c, 1))] += 1;
            balance[at(neighbour(c, 3))] -= 1;
        }
        for (const int c : corners_of(v)) {
            for (const int k : {1, 3}) {
                int& open = balance[at(neighbour(c, k))];
                if (open != 0) is_pinned_[at(v)] = 1;
                open = 0;
            }
        }
    }
    stays_ = is_pinned_;
    slides_.assign(quads_.vertex.size(), 0);
}

void SlidingQuads::let_slide(const std::vector<int>& edges) {
    if (edges.empty()) return;
    walk_.emplace(topology_, metric_, edges);
    for (std::size_t v = 0; v < quads_.vertex.size(); ++v) {
        if (walk_->edge_of(quads_.vertex[v]) < 0) continue;
        slides_[v] = walk_->is_passed(quads_.vertex[v]) ? 1 : 0;
        stays_[v] = is_pinned_[v] = slides_[v] ? 0 : 1;
        if (slides_[v]) quads_.vertex[v] = walk_->seat(quads_.vertex[v]);
    }
}

SlidingQuads::Range SlidingQuads::corners_of(int v) const {
    return {corner_.data() + corner_start_[at(v)], corner_.data() + corner_start_[at(v) + 1]};
}

int SlidingQuads::neighbour(int corner, int k) const {
    return quads_.Q.data()[(corner & ~3) + ((corner + k) & 3)];
}

QuadCorners SlidingQuads::corners_in(const Frame& frame, int quad) const {
    QuadCorners p;
    for (int k = 0; k < 4; ++k) p[at(k)] = frame.vertices.row(quads_.Q(quad, k)).transpose();
    return p;
}

double SlidingQuads::shape_cost() const {
    double sum = 0;
    for (const Frame& frame : shaped()) {
        for (int q = 0; q < static_cast<int>(quads_.Q.rows()); ++q) {
            sum += frame.weight * quad_cost(corners_in(frame, q), relaxing_barrier);
        }
    }
    return sum;
}

double SlidingQuads::cost_around(int v, const FoldBarrier& barrier) const {
    double sum = 0;
    for (const Frame& frame : shaped()) {
        for (const int c : corners_of(v)) {
            sum += frame.weight * quad_cost(corners_in(frame, c / 4), barrier);
        }
    }
    return sum;
}

/// Sum over the frames of the squared lengths of the edges at a vertex, in mean lengths.
double SlidingQuads::spacing_cost(int v) const {
    double sum = 0;
    for (const Frame& frame : shaped()) {
        double squares = 0;
        for (const int c : corners_of(v)) {
            for (const int k : {1, 3}) {
                squares +=
                    (frame.vertices.row(neighbour(c, k)) - frame.vertices.row(v)).squaredNorm();
            }
        }
        // An edge has a quad on either side.
        sum += frame.weight * squares / (2 * frame.mean_edge * frame.mean_edge);
    }
    return sum;
}

/// What passes lower: the cost of the quads around a vertex, and the lengths of its edges.
double SlidingQuads::relaxing_cost(int v) const {
    return cost_around(v, relaxing_barrier) + spacing_weight * spacing_cost(v);
}

/// Smallest scaled Jacobian of a quad over the references.
double SlidingQuads::least_jacobian_of(int quad) const {
    double least = 1;
    for (const Reference& reference : references_) {
        least = std::min(least, least_scaled_jacobian(corners_in(reference.frame, quad)));
    }
    return least;
}

double SlidingQuads::least_jacobian_around(int v) const {
    double least = 1;
    for (const int c : corners_of(v)) least = std::min(least, least_jacobian_of(c / 4));
    return least;
}

void SlidingQuads::place(int v, const SurfacePoint& point) {
    quads_.vertex[at(v)] = point;
    for (Frame& frame : frames_) {
        frame.vertices.row(v) = position_of(point, frame.input, F_).transpose();
    }
}

/// What a vector in the frame of triangle `t` is in space, in a frame whose vertices are `X`.
Eigen::Matrix<double, 3, 2> SlidingQuads::embedding(int t, const Positions& X) const {
    const auto layout = lay_out_triangle(side_lengths(topology_, metric_, t));
    Eigen::Matrix2d sides;
    sides << layout.col(1) - layout.col(0), layout.col(2) - layout.col(0);
    Eigen::Matrix<double, 3, 2> edges;
    edges.col(0) = (X.row(F_(t, 1)) - X.row(F_(t, 0))).transpose();
    edges.col(1) = (X.row(F_(t, 2)) - X.row(F_(t, 0))).transpose();
    return edges * sides.inverse();
}

/// Where vertex `v` should go for the squares around it, as a vector in the frame of its triangle:
/// the least-squares answer to what the frames ask for.
Vector2 SlidingQuads::move_to_squares(int v) const {
    Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();
    Vector2 right = Vector2::Zero();
    for (const Frame& frame : shaped()) {
        const auto tangents = embedding(quads_.vertex[at(v)].triangle, frame.input);
        const Vector3 normal = tangents.col(0).cross(tangents.col(1)).normalized();
        const Vector3 here = frame.vertices.row(v).transpose();
        Vector3 move = Vector3::Zero();
        int count = 0;
        for (const int c : corners_of(v)) {
            const QuadCorners p = corners_in(frame, c / 4);
            Vector3 plane = area_normal(p).normalized();
            // A folded quad is judged from the side of the surface.
            if (!(plane.dot(normal) > 0)) plane = normal;
            move += fitted_square_corner(p, plane, at(c & 3)) - here;
            ++count;
        }
        matrix += frame.weight * tangents.transpose() * tangents;
        right += frame.weight * tangents.transpose() * (move / count);
    }
    return matrix.inverse() * right;
}

/// Where vertex `v` should go for right angles in the quads around it: one damped step of Gauss and
/// Newton on the squared cosines of the corners that it is part of and the lengths of its edges.
Vector2 SlidingQuads::move_to_right_angles(int v) const {
    constexpr double damping = 0.1;
    Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();
    Vector2 right = Vector2::Zero();
    for (const Frame& frame : shaped()) {
        const auto tangents = embedding(quads_.vertex[at(v)].triangle, frame.input);
        const double spacing = spacing_weight / (2 * frame.mean_edge * frame.mean_edge);
        double stiffness = 0;
        Vector3 pull = Vector3::Zero();
        for (const int c : corners_of(v)) {
            const QuadCorners p = corners_in(frame, c / 4);
            const auto k = at(c & 3);
            for (const CornerCosine& corner : cosines_at(p, k)) {
                const Vector2 slope = tangents.transpose() * corner.gradient;
                matrix += frame.weight * slope * slope.transpose();
                right -= frame.weight * corner.cosine * slope;
            }
            stiffness += damping / (p[(k + 1) % 4] - p[k]).squaredNorm() + 2 * spacing;
            pull += spacing * (p[(k + 1) % 4] + p[(k + 3) % 4] - 2 * p[k]);
        }
        matrix += frame.weight * stiffness * tangents.transpose() * tangents;
        right += frame.weight * tangents.transpose() * pull;
    }
    return matrix.inverse() * right;
}

/// Where a straight walk of vertex `v` ends; `start` where it would end on the boundary, which is
/// the place of boundary vertices alone. Those on a line keep to it.
SurfacePoint SlidingQuads::walked(int v, const SurfacePoint& start, const Vector2& move) const {
    if (slides_[at(v)]) return walk_->walk(start, move);
    SurfacePoint end = trace_geodesic(topology_, metric_, start, move);
    for (int k = 0; k < 3; ++k) {
        const int opposite = 3 * end.triangle + (k + 1) % 3;
        if (end.barycentric[k] < 1e-9 && topology_.twin[at(opposite)] < 0) return start;
    }
    return end;
}

void SlidingQuads::release() { is_pinned_ = stays_; }

/// Largest `distance_of` among the quads around `v` that are watched; 0 where none is.
double SlidingQuads::watched_distance(int v) const {
    double farthest = 0;
    for (const int c : corners_of(v)) {
        if (is_watched_[at(c / 4)]) farthest = std::max(farthest, distance_of(c / 4, near_share));
    }
    return farthest;
}

/// Length of the first side of the first quad at `v` in the first reference: a size of steps there.
double SlidingQuads::first_side_length(int v) const {
    const Positions& X = frames_[0].vertices;
    return (X.row(neighbour(*corners_of(v).begin(), 1)) - X.row(v)).norm();
}

/// Length of the shortest edge at `v` in the first reference.
double SlidingQuads::shortest_edge(int v) const {
    const Positions& X = frames_[0].vertices;
    double shortest = std::numeric_limits<double>::infinity();
    for (const int c : corners_of(v)) {
        for (const int k : {1, 3}) {
            shortest = std::min(shortest, (X.row(neighbour(c, k)) - X.row(v)).norm());
        }
    }
    return shortest;
}

/// What no move takes the shortest edge at `v` below: vertices must not come together, as they
/// could at the end of a line.
double SlidingQuads::least_edge_at(int v) const {
    return std::min(shortest_edge(v), least_edge_share * frames_[0].mean_edge);
}

/// The longest edge at `v` in a frame, by the mean length of the edges there.
double SlidingQuads::longest_edge(int v, const Frame& frame) const {
    double square = 0;
    for (const int c : corners_of(v)) {
        for (const int k : {1, 3}) {
            const auto edge = frame.vertices.row(neighbour(c, k)) - frame.vertices.row(v);
            square = std::max(square, edge.squaredNorm());
        }
    }
    return std::sqrt(square) / frame.mean_edge;
}

/// The same, at most over the frames with a weight.
double SlidingQuads::longest_edge(int v) const {
    double longest = 0;
    for (const Frame& frame : shaped()) longest = std::max(longest, longest_edge(v, frame));
    return longest;
}

bool SlidingQuads::improve(int v, Aim aim, double distance_limit) {
    const Vector2 move = aim == Aim::squares ? move_to_squares(v) : move_to_right_angles(v);
    const SurfacePoint before = quads_.vertex[at(v)];
    if (!move.allFinite() || move.norm() < least_move * first_side_length(v)) return false;
    const double cost_before = relaxing_cost(v);
    const double allowed = std::max(distance_limit, watched_distance(v));
    const double least = std::min(least_jacobian_around(v), least_kept_jacobian);
    const double longest = std::max(longest_edge(v), most_stretch);
    const double shortest = least_edge_at(v);
    // Right angles are a matter of whole rows, which come along faster if every vertex goes too
    // far.
    constexpr double over_relaxation = 1.8;
    for (const double length : {aim == Aim::squares ? 1.0 : over_relaxation, 0.4}) {
        place(v, walked(v, before, length * move));
        if (shortest_edge(v) >= shortest && relaxing_cost(v) < cost_before &&
            longest_edge(v) <= longest && least_jacobian_around(v) >= least &&
            watched_distance(v) <= allowed) {
            return true;
        }
    }
    place(v, before);
    return false;
}

/// Whether the middles of a quad and of its sides are near the input in the references.
bool SlidingQuads::is_near(int quad) {
    bool result = true;
    for (const Reference& reference : references_) {
        const QuadCorners p = corners_in(reference.frame, quad);
        const double near_distance = near_share * reference.frame.mean_edge;
        const double near = near_distance * near_distance;
        for (std::size_t k = 0; k < 5; ++k) {
            const Vector3 point = k < 4 ? Vector3((p[k] + p[(k + 1) % 4]) / 2)
                                        : Vector3((p[0] + p[1] + p[2] + p[3]) / 4);
            int& hint = hints_[at(5 * quad) + k];
            const ClosestPoint found = reference.surface.find_unless_near(near, point, hint);
            hint = found.point.triangle;
            if (found.squared_distance > near) result = false;
        }
    }
    return result;
}

int SlidingQuads::relax_pass(Aim aim, double distance_limit, const Context& context) {
    // Distances are slow: they are asked for only where quads are about to leave the surface.
    is_watched_.resize(at(static_cast<int>(quads_.Q.rows())));
    for (int q = 0; q < static_cast<int>(quads_.Q.rows()); ++q) {
        is_watched_[at(q)] =
            !is_near(q) && distance_of(q, near_share) > 0.5 * distance_limit ? 1 : 0;
    }
    int moves = 0;
    for (int v = 0; v < static_cast<int>(quads_.vertex.size()); ++v) {
        if (v % 512 == 0) context.check_cancelled();
        if (is_pinned_[at(v)] == 0) moves += improve(v, aim, distance_limit) ? 1 : 0;
    }
    return moves;
}

/// The frame in which vertex `x` of the input and a point of the quads, cut to triangles `cut`, are
/// farthest apart, if they are by more than `most_apart` edges: they lie on different limbs. -1
/// where they stay together.
int SlidingQuads::frame_that_parts(int x, const SurfacePoint& point, const Triangles& cut) const {
    int parting = -1;
    double farthest = most_apart;
    for (int f = 0; f < static_cast<int>(frames_.size()); ++f) {
        const Frame& frame = frames_[at(f)];
        const Vector3 between =
            frame.input.row(x).transpose() - position_of(point, frame.vertices, cut);
        const double distance = between.norm() / frame.mean_edge;
        if (distance <= farthest) continue;
        farthest = distance;
        parting = f;
    }
    return parting;
}

std::vector<SlidingQuads::Far> SlidingQuads::input_farther_than(double distance,
                                                                const Reference& reference,
                                                                const Context& context) const {
    const Frame& frame = reference.frame;
    const Triangles cut = cut_quads(quads_.Q, frame.vertices);
    const ClosestPoints quads(frame.vertices, cut);
    std::vector<std::optional<ClosestPoints>> quads_in(frames_.size());
    std::vector<Far> far;
    int hint = -1;
    for (int x = 0; x < topology_.vertex_count; ++x) {
        if (x % 4096 == 0) context.check_cancelled();
        if (topology_.vertex_half_edge[at(x)] < 0) continue;
        const ClosestPoint closest = quads.find(frame.input.row(x).transpose(), hint);
        hint = closest.point.triangle;
        double squared_distance = closest.squared_distance;
        int quad = hint / 2;
        // Where limbs touch, what is closest may belong to another one.
        if (const int f = frame_that_parts(x, closest.point, cut); f >= 0) {
            const Frame& apart = frames_[at(f)];
            if (!quads_in[at(f)]) quads_in[at(f)].emplace(apart.vertices, cut);
            const ClosestPoint own = quads_in[at(f)]->find(apart.input.row(x).transpose(), -1);
            if (own.squared_distance > squared_distance) {
                squared_distance = own.squared_distance;
                quad = own.point.triangle / 2;
            }
        }
        if (squared_distance > distance * distance) {
            far.push_back({std::sqrt(squared_distance), x, quad});
        }
    }
    return far;
}

std::vector<double> SlidingQuads::distances(const Context& context) const {
    std::vector<double> farthest(at(static_cast<int>(quads_.Q.rows())));
    for (int q = 0; q < static_cast<int>(quads_.Q.rows()); ++q) farthest[at(q)] = distance_of(q);
    for (const Reference& reference : references_) {
        for (const Far& far : input_farther_than(0, reference, context)) {
            farthest[at(far.quad)] = std::max(farthest[at(far.quad)], far.distance);
        }
    }
    return farthest;
}

void SlidingQuads::hold(int quad) {
    for (int k = 0; k < 4; ++k) is_pinned_[at(quads_.Q(quad, k))] = 1;
}

void SlidingQuads::restore(const State& state) {
    for (int v = 0; v < static_cast<int>(state.vertex.size()); ++v) place(v, state.vertex[at(v)]);
    is_pinned_ = state.is_pinned;
}

void SlidingQuads::restore(const State& state, const std::vector<int>& region) {
    for (const int q : region) {
        for (int k = 0; k < 4; ++k) {
            const int v = quads_.Q(q, k);
            place(v, state.vertex[at(v)]);
            is_pinned_[at(v)] = state.is_pinned[at(v)];
        }
    }
}

std::vector<std::vector<int>> SlidingQuads::regions_moved_since(const State& state) const {
    std::vector<char> is_reached(quads_.vertex.size());
    for (std::size_t v = 0; v < is_reached.size(); ++v) {
        is_reached[v] = quads_.vertex[v] == state.vertex[v] ? 1 : 0;
    }
    std::vector<char> is_listed(at(static_cast<int>(quads_.Q.rows())), 0);
    std::vector<std::vector<int>> regions;
    for (int seed = 0; seed < static_cast<int>(is_reached.size()); ++seed) {
        if (is_reached[at(seed)]) continue;
        is_reached[at(seed)] = 1;
        std::vector<int> stack = {seed};
        std::vector<int>& region = regions.emplace_back();
        while (!stack.empty()) {
            const int v = stack.back();
            stack.pop_back();
            for (const int c : corners_of(v)) {
                if (is_listed[at(c / 4)]) continue;
                is_listed[at(c / 4)] = 1;
                region.push_back(c / 4);
                for (int k = 0; k < 4; ++k) {
                    const int w = quads_.Q(c / 4, k);
                    if (is_reached[at(w)]) continue;
                    is_reached[at(w)] = 1;
                    stack.push_back(w);
                }
            }
        }
    }
    return regions;
}

double SlidingQuads::mean_edge_length(const Frame& frame) const {
    double sum = 0;
    for (int c = 0; c < static_cast<int>(quads_.Q.size()); ++c) {
        sum += (frame.vertices.row(neighbour(c, 1)) - frame.vertices.row(neighbour(c, 0))).norm();
    }
    return quads_.Q.size() > 0 ? sum / static_cast<double>(quads_.Q.size()) : 0;
}

}  // namespace kinequad
