#include "kinequad/relax/sliding_quads.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "kinequad/mesh/trace_geodesic.h"

namespace kinequad {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Moves shorter than this share of the quad's size are not worth a try.
constexpr double least_move = 0.01;
constexpr FoldBarrier relaxing_barrier;
/// A quad that covers an extremity may become this slanted, but no more.
constexpr double least_covering_jacobian = 0.15;

/// Quads as triangles, cut along the shorter diagonal: triangles 2q and 2q + 1 of quad q.
Triangles cut_quads(const Quads& Q, const Positions& X) {
    Triangles F(2 * Q.rows(), 3);
    for (Eigen::Index q = 0; q < Q.rows(); ++q) {
        const double first = (X.row(Q(q, 0)) - X.row(Q(q, 2))).squaredNorm();
        const double second = (X.row(Q(q, 1)) - X.row(Q(q, 3))).squaredNorm();
        const int k = first <= second ? 0 : 1;
        F.row(2 * q) << Q(q, k), Q(q, k + 1), Q(q, k + 2);
        F.row(2 * q + 1) << Q(q, k), Q(q, k + 2), Q(q, (k + 3) % 4);
    }
    return F;
}

}  // namespace

SlidingQuads::SlidingQuads(const QuadMesh& quads, const Topology& topology,
                           const IntrinsicMetric& metric, const Triangles& F,
                           std::vector<SampledFrame> frames)
    : quads_(quads), topology_(topology), metric_(metric), F_(F) {
    link_corners();
    pin_boundary();
    for (SampledFrame& frame : frames) {
        Frame own{std::move(frame.input), {}, frame.weight};
        own.vertices.resize(static_cast<Eigen::Index>(quads.vertex.size()), 3);
        frames_.push_back(std::move(own));
    }
    for (int v = 0; v < static_cast<int>(quads_.vertex.size()); ++v) place(v, quads_.vertex[at(v)]);
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
    is_on_boundary_ = is_pinned_;
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

double SlidingQuads::cost_around(int v, const FoldBarrier& barrier) const {
    double sum = 0;
    for (const Frame& frame : frames_) {
        for (const int c : corners_of(v)) {
            sum += frame.weight * quad_cost(corners_in(frame, c / 4), barrier);
        }
    }
    return sum;
}

double SlidingQuads::least_jacobian_around(int v) const {
    double least = 1;
    for (const int c : corners_of(v)) {
        least = std::min(least, least_scaled_jacobian(corners_in(frames_[0], c / 4)));
    }
    return least;
}

void SlidingQuads::place(int v, const SurfacePoint& point) {
    quads_.vertex[at(v)] = point;
    for (Frame& frame : frames_) {
        frame.vertices.row(v) = position_of(point, frame.input, F_).transpose();
    }
}

/// Where vertex `v` should go, as a vector in the frame of its triangle: the least-squares answer
/// to what the frames ask for.
Vector2 SlidingQuads::wanted_move(int v) const {
    const SurfacePoint& point = quads_.vertex[at(v)];
    const auto layout = lay_out_triangle(side_lengths(topology_, metric_, point.triangle));
    Eigen::Matrix2d sides;
    sides << layout.col(1) - layout.col(0), layout.col(2) - layout.col(0);
    const Eigen::Matrix2d to_sides = sides.inverse();
    Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();
    Vector2 right = Vector2::Zero();
    const auto triangle = F_.row(point.triangle);
    for (const Frame& frame : frames_) {
        Eigen::Matrix<double, 3, 2> edges;
        edges.col(0) = (frame.input.row(triangle[1]) - frame.input.row(triangle[0])).transpose();
        edges.col(1) = (frame.input.row(triangle[2]) - frame.input.row(triangle[0])).transpose();
        const Vector3 normal = edges.col(0).cross(edges.col(1)).normalized();
        const Eigen::Matrix<double, 3, 2> embedding = edges * to_sides;
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
        matrix += frame.weight * embedding.transpose() * embedding;
        right += frame.weight * embedding.transpose() * (move / count);
    }
    return matrix.inverse() * right;
}

void SlidingQuads::release() { is_pinned_ = is_on_boundary_; }

/// Largest `distance_of` among the quads around `v` that are watched; 0 where none is.
double SlidingQuads::watched_distance(int v, const ClosestPoints& surface) const {
    double farthest = 0;
    for (const int c : corners_of(v)) {
        if (is_watched_[at(c / 4)]) farthest = std::max(farthest, distance_of(c / 4, surface));
    }
    return farthest;
}

bool SlidingQuads::improve(int v, double distance_limit, const ClosestPoints& surface) {
    const Vector2 move = wanted_move(v);
    const SurfacePoint before = quads_.vertex[at(v)];
    const Positions& X = frames_[0].vertices;
    const double size = (X.row(neighbour(*corners_of(v).begin(), 1)) - X.row(v)).norm();
    if (!move.allFinite() || move.norm() < least_move * size) return false;
    const double cost_before = cost_around(v, relaxing_barrier);
    const double allowed = std::max(distance_limit, watched_distance(v, surface));
    for (const double length : {1.0, 0.4}) {
        place(v, trace_geodesic(topology_, metric_, before, length * move));
        if (cost_around(v, relaxing_barrier) < cost_before &&
            watched_distance(v, surface) <= allowed) {
            return true;
        }
    }
    place(v, before);
    return false;
}

int SlidingQuads::relax_pass(double distance_limit, const ClosestPoints& surface,
                             const Context& context) {
    // Distances are slow: they are asked for only where quads are about to leave the surface.
    is_watched_.resize(at(static_cast<int>(quads_.Q.rows())));
    for (int q = 0; q < static_cast<int>(quads_.Q.rows()); ++q) {
        is_watched_[at(q)] = distance_of(q, surface) > 0.5 * distance_limit ? 1 : 0;
    }
    int moves = 0;
    for (int v = 0; v < static_cast<int>(quads_.vertex.size()); ++v) {
        if (v % 512 == 0) context.check_cancelled();
        if (is_pinned_[at(v)] == 0) moves += improve(v, distance_limit, surface) ? 1 : 0;
    }
    return moves;
}

/// Moves vertex `v` to where `cost` is least among places around it, if that is less than here.
void SlidingQuads::search_around(int v, const std::function<double()>& cost) {
    constexpr int directions = 12;
    const Positions& X = frames_[0].vertices;
    const double size = (X.row(neighbour(*corners_of(v).begin(), 1)) - X.row(v)).norm();
    const SurfacePoint before = quads_.vertex[at(v)];
    SurfacePoint best = before;
    double least = cost();
    for (const double length : {0.9, 0.5, 0.25, 0.12, 0.06, 0.03}) {
        for (int i = 0; i < directions; ++i) {
            const double angle = 2 * std::numbers::pi * (i + 5 * length) / directions;
            const Vector2 step = length * size * Vector2(std::cos(angle), std::sin(angle));
            place(v, trace_geodesic(topology_, metric_, before, step));
            const double value = cost();
            if (value < least) {
                least = value;
                best = quads_.vertex[at(v)];
            }
        }
    }
    place(v, best);
}

/// The corners of a quad and all vertices up to `reach` quads farther on, in ascending order.
std::vector<int> SlidingQuads::vertices_around(int quad, int reach) const {
    std::vector<int> around;
    for (int k = 0; k < 4; ++k) around.push_back(quads_.Q(quad, k));
    for (int ring = 0; ring < reach; ++ring) {
        std::vector<int> wider = around;
        for (const int v : around) {
            for (const int c : corners_of(v)) {
                wider.insert(wider.end(), {neighbour(c, 1), neighbour(c, 2), neighbour(c, 3)});
            }
        }
        std::sort(wider.begin(), wider.end());
        wider.erase(std::unique(wider.begin(), wider.end()), wider.end());
        around = std::move(wider);
    }
    std::sort(around.begin(), around.end());
    return around;
}

int SlidingQuads::unfold_pass(double safe_jacobian, int reach, const Context& context) {
    const FoldBarrier barrier{safe_jacobian, 100};
    // The reference frame decides; the others only choose among what unfolds it alike.
    const auto cost = [&](int v) {
        double sum = 0.1 * cost_around(v, relaxing_barrier);
        for (const int c : corners_of(v)) {
            sum += static_cast<double>(frames_.size()) *
                   quad_cost(corners_in(frames_[0], c / 4), barrier);
        }
        return sum;
    };
    int folded = 0;
    for (int q = 0; q < static_cast<int>(quads_.Q.rows()); ++q) {
        if (least_scaled_jacobian(corners_in(frames_[0], q)) >= safe_jacobian) continue;
        context.check_cancelled();
        for (const int v : vertices_around(q, reach)) {
            if (is_pinned_[at(v)] == 0) search_around(v, [&] { return cost(v); });
        }
        folded += least_scaled_jacobian(corners_in(frames_[0], q)) <= 0 ? 1 : 0;
    }
    return folded;
}

/// How far the middle of a quad and of its edges are from the input in the reference frame.
double SlidingQuads::distance_of(int quad, const ClosestPoints& surface) const {
    const QuadCorners p = corners_in(frames_[0], quad);
    int hint = quads_.vertex[at(quads_.Q(quad, 0))].triangle;
    double farthest = 0;
    const auto look = [&](const Vector3& point) {
        const ClosestPoint closest = surface.find(point, hint);
        hint = closest.point.triangle;
        farthest = std::max(farthest, closest.squared_distance);
    };
    look((p[0] + p[1] + p[2] + p[3]) / 4);
    for (std::size_t k = 0; k < 4; ++k) look((p[k] + p[(k + 1) % 4]) / 2);
    return std::sqrt(farthest);
}

int SlidingQuads::hug_surface(double limit, int reach, const ClosestPoints& surface,
                              const Context& context) {
    constexpr double distance_weight = 40;
    const FoldBarrier barrier{0.2, 100};
    int far = 0;
    for (int q = 0; q < static_cast<int>(quads_.Q.rows()); ++q) {
        if (q % 256 == 0) context.check_cancelled();
        if (distance_of(q, surface) <= limit) continue;
        for (const int v : vertices_around(q, reach)) {
            if (is_pinned_[at(v)]) continue;
            search_around(v, [&] {
                double sum = cost_around(v, barrier) / static_cast<double>(frames_.size());
                for (const int c : corners_of(v)) {
                    const double excess = std::max(0.0, distance_of(c / 4, surface) / limit - 0.5);
                    sum += distance_weight * excess * excess;
                }
                return sum;
            });
        }
        far += distance_of(q, surface) > limit ? 1 : 0;
    }
    return far;
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
    place(v, goal);
    for (int round = 0; round < 2 && least_around() < enough; ++round) {
        for (const auto& [w, point] : before) {
            if (w == v || is_pinned_[at(w)]) continue;
            search_around(w, [&] { return cost_around(w, barrier); });
        }
    }
    if (least_around() >= enough) return true;
    for (const auto& [w, point] : before) place(w, point);
    return false;
}

int SlidingQuads::cover_extremities(double limit, const Context& context) {
    const Frame& reference = frames_[0];
    const ClosestPoints surface(reference.vertices, cut_quads(quads_.Q, reference.vertices));
    struct Far {
        double distance;
        int vertex;
        int quad;
    };
    std::vector<Far> far;
    int hint = -1;
    for (int x = 0; x < topology_.vertex_count; ++x) {
        if (x % 4096 == 0) context.check_cancelled();
        if (topology_.vertex_half_edge[at(x)] < 0) continue;
        const ClosestPoint closest = surface.find(reference.input.row(x).transpose(), hint);
        hint = closest.point.triangle;
        if (closest.squared_distance > limit * limit)
            far.push_back({closest.squared_distance, x, hint / 2});
    }
    std::sort(far.begin(), far.end(), [](const Far& a, const Far& b) {
        return a.distance != b.distance ? a.distance > b.distance : a.vertex < b.vertex;
    });

    int placed = 0;
    std::vector<char> is_busy(at(static_cast<int>(quads_.Q.rows())), 0);
    for (const Far& f : far) {
        // One extremity a quad at a time: moving its corner changes all distances around.
        if (is_busy[at(f.quad)]) continue;
        std::array<std::pair<double, int>, 4> corners;
        for (int k = 0; k < 4; ++k) {
            const int v = quads_.Q(f.quad, k);
            corners[at(k)] = {
                (reference.vertices.row(v) - reference.input.row(f.vertex)).squaredNorm(), v};
        }
        std::sort(corners.begin(), corners.end());
        const int h = topology_.vertex_half_edge[at(f.vertex)];
        const SurfacePoint extremity{h / 3, Vector3::Unit(h % 3)};
        for (const auto& [distance, v] : corners) {
            if (is_pinned_[at(v)]) continue;
            if (!move_onto(v, extremity)) continue;
            is_pinned_[at(v)] = 1;
            for (const int c : corners_of(v)) is_busy[at(c / 4)] = 1;
            ++placed;
            break;
        }
    }
    return placed;
}

double SlidingQuads::largest_distance(const ClosestPoints& surface) const {
    double farthest = 0;
    for (int q = 0; q < static_cast<int>(quads_.Q.rows()); ++q) {
        farthest = std::max(farthest, distance_of(q, surface));
    }
    const Frame& reference = frames_[0];
    const ClosestPoints quads(reference.vertices, cut_quads(quads_.Q, reference.vertices));
    int hint = -1;
    for (int x = 0; x < topology_.vertex_count; ++x) {
        if (topology_.vertex_half_edge[at(x)] < 0) continue;
        const ClosestPoint closest = quads.find(reference.input.row(x).transpose(), hint);
        hint = closest.point.triangle;
        farthest = std::max(farthest, std::sqrt(closest.squared_distance));
    }
    return farthest;
}

int SlidingQuads::count_folded() const {
    int folded = 0;
    for (int q = 0; q < static_cast<int>(quads_.Q.rows()); ++q) {
        folded += least_scaled_jacobian(corners_in(frames_[0], q)) <= 0 ? 1 : 0;
    }
    return folded;
}

void SlidingQuads::restore(const QuadMesh& quads) {
    for (int v = 0; v < static_cast<int>(quads.vertex.size()); ++v) place(v, quads.vertex[at(v)]);
    release();
}

double SlidingQuads::mean_edge_length() const {
    double sum = 0;
    for (int c = 0; c < static_cast<int>(quads_.Q.size()); ++c) {
        sum += (frames_[0].vertices.row(neighbour(c, 1)) - frames_[0].vertices.row(neighbour(c, 0)))
                   .norm();
    }
    return quads_.Q.size() > 0 ? sum / static_cast<double>(quads_.Q.size()) : 0;
}

}  // namespace kinequad
