#include "kinequad/gridmap/cone_triangulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "kinequad/core/error.h"

namespace kinequad {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

using Rows = Eigen::Matrix<int, 2, Eigen::Dynamic>;

double cross(Complex a, Complex b) { return std::imag(std::conj(a) * b); }

Rows turn_rows(const Rows& rows, int quarters) {
    if (rows.cols() == 0 || (quarters & 3) == 0) return rows;
    Rows result(2, rows.cols());
    switch (quarters & 3) {
        case 1:
            result.row(0) = -rows.row(1);
            result.row(1) = rows.row(0);
            break;
        case 2:
            result = -rows;
            break;
        default:
            result.row(0) = rows.row(1);
            result.row(1) = -rows.row(0);
    }
    return result;
}

Rows add_rows(const Rows& a, const Rows& b) {
    if (a.cols() == 0) return b;
    if (b.cols() == 0) return a;
    return a + b;
}

/// Areas below this many cells count as none.
constexpr double no_area = 1e-9;

}  // namespace

ConeTriangulation::ConeTriangulation(const ChartedMesh& mesh, const MapVariables& variables,
                                     const std::vector<Complex>& corners,
                                     const Eigen::VectorXd& integers)
    : origin_(mesh.origin),
      twin_(mesh.twin),
      rotation_(mesh.rotation),
      displacement_(mesh.origin.size()),
      rows_(mesh.origin.size()),
      is_dead_(mesh.parent.size(), 0),
      integers_(integers) {
    const auto row_of = [&](std::size_t corner, int k) -> const LinearForm<long>& {
        return variables.integer_part[2 * corner + at(k)];
    };
    for (std::size_t h = 0; h < origin_.size(); ++h) {
        const auto end = at(Topology::next(static_cast<int>(h)));
        displacement_[h] = corners[end] - corners[h];
        if (row_of(h, 0).empty() && row_of(h, 1).empty() && row_of(end, 0).empty() &&
            row_of(end, 1).empty()) {
            continue;
        }
        Rows rows = Rows::Zero(2, integers.size());
        for (int k = 0; k < 2; ++k) {
            for (const auto& [y, c] : row_of(end, k)) rows(k, y) += static_cast<int>(c);
            for (const auto& [y, c] : row_of(h, k)) rows(k, y) -= static_cast<int>(c);
        }
        if (!rows.isZero()) rows_[h] = std::move(rows);
    }
    for (int t = 0; t < static_cast<int>(is_dead_.size()); ++t) alive_.push_back(t);
    make_delaunay();
    take_out_vertices(variables, mesh.vertex_count);
    compact();
    // What is left joins nodes only: its displacements follow from y alone, without drift.
    snap(integers);
    make_delaunay();
}

Complex ConeTriangulation::rows_times(const Rows& rows, const Eigen::VectorXd& y) const {
    if (rows.cols() == 0) return 0;
    return {rows.row(0).cast<double>().dot(y), rows.row(1).cast<double>().dot(y)};
}

void ConeTriangulation::snap(const Eigen::VectorXd& integers) {
    integers_ = integers;
    for (const int t : alive_) {
        for (int h = 3 * t; h < 3 * t + 3; ++h)
            displacement_[at(h)] = rows_times(rows_[at(h)], integers);
    }
}

void ConeTriangulation::scale(double factor) {
    integers_ *= factor;
    for (const int t : alive_) {
        for (int h = 3 * t; h < 3 * t + 3; ++h) displacement_[at(h)] *= factor;
    }
}

bool ConeTriangulation::can_flip(int h, double least) const {
    const int g = twin_[at(h)];
    if (g < 0 || g / 3 == h / 3) return false;
    const int r = rotation_[at(h)];
    const Complex ca = displacement_[at(Topology::previous(h))];
    const Complex bc = displacement_[at(Topology::next(h))];
    const Complex ad = turn(displacement_[at(Topology::next(g))], -r);
    const Complex db = turn(displacement_[at(Topology::previous(g))], -r);
    // Triangles (a, d, c) and (d, b, c).
    return cross(ca, ad) > least && cross(db, bc) > least;
}

void ConeTriangulation::flip(int h) {
    // Names: h = a -> b with apex c; its twin g = b -> a with apex d. See `can_flip`.
    const int g = twin_[at(h)];
    const int r = rotation_[at(h)];
    const int hn = Topology::next(h);
    const int hp = Topology::previous(h);
    const int gn = Topology::next(g);
    const int gp = Topology::previous(g);
    const int a = origin_[at(h)];
    const int b = origin_[at(g)];
    const int c = origin_[at(hp)];
    const int d = origin_[at(gp)];

    struct Side {
        int old_slot;
        int new_slot;
        int turns;  ///< of its chart, from old to new
        int twin;
        int rotation;
        Complex displacement;
        Rows rows;
    };
    const auto side = [&](int old_slot, int new_slot, int turns) {
        return Side{old_slot,
                    new_slot,
                    turns,
                    twin_[at(old_slot)],
                    rotation_[at(old_slot)],
                    turn(displacement_[at(old_slot)], turns),
                    turn_rows(rows_[at(old_slot)], turns)};
    };
    std::array<Side, 4> sides = {side(hn, hp, 0), side(hp, gn, r), side(gn, gp, 0),
                                 side(gp, hn, -r)};

    const Complex cd = displacement_[at(hp)] + turn(displacement_[at(gn)], -r);
    Rows cd_rows = add_rows(rows_[at(hp)], turn_rows(rows_[at(gn)], -r));
    for (const Side& s : sides) {
        int twin = s.twin;
        int rotation = s.rotation - s.turns;
        for (const Side& other : sides) {
            if (s.twin != other.old_slot) continue;
            twin = other.new_slot;
            rotation += other.turns;
            break;
        }
        twin_[at(s.new_slot)] = twin;
        rotation_[at(s.new_slot)] = rotation & 3;
        if (twin >= 0) {
            twin_[at(twin)] = s.new_slot;
            rotation_[at(twin)] = -rotation & 3;
        }
    }
    for (Side& s : sides) {
        displacement_[at(s.new_slot)] = s.displacement;
        rows_[at(s.new_slot)] = std::move(s.rows);
    }
    displacement_[at(h)] = cd;
    displacement_[at(g)] = turn(-cd, r);
    rows_[at(g)] = turn_rows(cd_rows, r + 2);
    rows_[at(h)] = std::move(cd_rows);
    origin_[at(h)] = c;
    origin_[at(hn)] = d;
    origin_[at(hp)] = b;
    origin_[at(g)] = d;
    origin_[at(gn)] = c;
    origin_[at(gp)] = a;
}

void ConeTriangulation::make_delaunay() {
    std::vector<int> queue;
    for (const int t : alive_) queue.insert(queue.end(), {3 * t, 3 * t + 1, 3 * t + 2});
    const auto opposite_cotangent = [&](int h) {
        const Complex left = -displacement_[at(Topology::next(h))];
        const Complex right = displacement_[at(Topology::previous(h))];
        const double area = cross(displacement_[at(h)], -right);
        return std::real(std::conj(left) * right) / std::max(area, 1e-300);
    };
    const std::size_t most = 50 * queue.size() + 1000;
    for (std::size_t i = 0; i < queue.size() && i < most; ++i) {
        const int h = queue[i];
        const int g = twin_[at(h)];
        if (g < 0 || is_dead_[at(h / 3)]) continue;
        if (opposite_cotangent(h) + opposite_cotangent(g) > -1e-9 || !can_flip(h, no_area))
            continue;
        flip(h);
        for (const int e :
             {Topology::next(h), Topology::previous(h), Topology::next(g), Topology::previous(g)}) {
            queue.push_back(e);
        }
    }
}

void ConeTriangulation::take_out_vertices(const MapVariables& variables, int vertex_count) {
    std::vector<int> outgoing(at(vertex_count), -1);
    const auto refresh = [&] {
        std::fill(outgoing.begin(), outgoing.end(), -1);
        for (int h = 0; h < static_cast<int>(origin_.size()); ++h) {
            if (!is_dead_[at(h / 3)]) outgoing[at(origin_[at(h)])] = h;
        }
    };
    refresh();
    std::vector<int> left;
    for (int v = 0; v < vertex_count; ++v) {
        if (!variables.is_node[at(v)] && outgoing[at(v)] >= 0) left.push_back(v);
    }
    // A vertex whose star has edges to itself has to wait for others to go.
    int idle = 0;
    while (!left.empty()) {
        std::vector<int> waiting;
        for (const int v : left) {
            if (!take_out(v, outgoing)) waiting.push_back(v);
        }
        idle = waiting.size() == left.size() ? idle + 1 : 0;
        if (idle == 3) {
            throw GridMapError(fmt::format(
                "{} regular vertices cannot be taken out of the cone metric, vertex {} first",
                waiting.size(), waiting.front()));
        }
        left = std::move(waiting);
        // Rings around thin limbs are left sheared: unwind them.
        make_delaunay();
        refresh();
    }
}

bool ConeTriangulation::take_out(int v, std::vector<int>& outgoing) {
    const auto touch = [&](int h) { outgoing[at(origin_[at(h)])] = h; };
    for (int guard = 0; guard < 1000; ++guard) {
        // The fan around v, counter-clockwise, from the boundary on where there is one.
        std::vector<int> fan;
        int start = outgoing[at(v)];
        bool open = false;
        for (int h = start;;) {
            const int g = twin_[at(h)];
            if (g < 0) {
                start = h;
                open = true;
                break;
            }
            h = Topology::next(g);
            if (h == start) break;
        }
        for (int h = start;;) {
            fan.push_back(h);
            h = twin_[at(Topology::previous(h))];
            if (h < 0 || h == start) break;
        }
        const std::size_t wanted = open ? 2 : 3;
        if (fan.size() < wanted) return false;
        if (fan.size() == wanted) {
            for (const int h : fan) {
                if (origin_[at(Topology::next(h))] == v) return false;
            }
            if (open && origin_[at(Topology::previous(fan.back()))] == v) return false;
            // Merge the fan into the triangle of its first half-edge.
            const int keep = fan[0];
            const int t = keep / 3;
            std::array<int, 3>
                outer{};  // edges of the merged triangle, as old slots or -1 for the new one
            std::array<int, 3> to_keep{};
            int turns = 0;
            for (std::size_t i = 0; i < fan.size(); ++i) {
                if (i > 0) turns += rotation_[at(fan[i])];
                outer[i] = Topology::next(fan[i]);
                to_keep[i] = turns;
            }
            struct Side {
                int origin, twin, rotation;
                Complex displacement;
                Rows rows;
            };
            std::vector<Side> merged;
            for (std::size_t i = 0; i < fan.size(); ++i) {
                const int s = outer[i];
                merged.push_back({origin_[at(s)], twin_[at(s)], rotation_[at(s)] - to_keep[i],
                                  turn(displacement_[at(s)], to_keep[i]),
                                  turn_rows(rows_[at(s)], to_keep[i])});
            }
            if (open) {
                // The two boundary edges at v lie on one line and become one.
                const int in = Topology::previous(fan.back());
                merged.push_back({origin_[at(in)], -1, 0,
                                  turn(displacement_[at(in)], to_keep[1]) + displacement_[at(keep)],
                                  add_rows(turn_rows(rows_[at(in)], to_keep[1]), rows_[at(keep)])});
            }
            // Sides glued to one another keep their glue in the merged numbering.
            for (Side& s : merged) {
                for (std::size_t j = 0; j < fan.size(); ++j) {
                    if (s.twin == outer[j]) {
                        s.twin = 3 * t + static_cast<int>(j);
                        s.rotation += to_keep[j];
                        break;
                    }
                }
            }
            for (std::size_t i = 1; i < fan.size(); ++i) is_dead_[at(fan[i] / 3)] = 1;
            for (std::size_t i = 0; i < 3; ++i) {
                const int slot = 3 * t + static_cast<int>(i);
                Side& s = merged[i];
                origin_[at(slot)] = s.origin;
                twin_[at(slot)] = s.twin;
                rotation_[at(slot)] = s.rotation & 3;
                displacement_[at(slot)] = s.displacement;
                rows_[at(slot)] = std::move(s.rows);
                if (s.twin >= 0) {
                    twin_[at(s.twin)] = slot;
                    rotation_[at(s.twin)] = -s.rotation & 3;
                }
                touch(slot);
            }
            outgoing[at(v)] = -1;
            return true;
        }
        // Flip the edge at v that leaves the fattest triangles behind. Just before v goes, it may
        // lie on both diagonals of its neighbours: then a triangle without area, which goes with
        // it.
        const bool is_last =
            fan.size() == wanted + 1 && std::none_of(fan.begin(), fan.end(), [&](int h) {
                return origin_[at(Topology::next(h))] == v ||
                       origin_[at(Topology::previous(h))] == v;
            });
        int best = -1;
        double best_area = is_last ? -1e-10 : 1e-14;
        for (const int h : fan) {
            const int g = twin_[at(h)];
            if (g < 0 || g / 3 == h / 3) continue;
            const int r = rotation_[at(h)];
            const Complex ca = displacement_[at(Topology::previous(h))];
            const Complex bc = displacement_[at(Topology::next(h))];
            const Complex ad = turn(displacement_[at(Topology::next(g))], -r);
            const Complex db = turn(displacement_[at(Topology::previous(g))], -r);
            double least = std::min(cross(ca, ad), cross(db, bc));
            // An edge from v to itself counts twice: flip it first.
            if (origin_[at(g)] == v && least > 1e-14) least += 1e6;
            // The new edge must not end at v again.
            if (origin_[at(Topology::previous(h))] == v || origin_[at(Topology::previous(g))] == v)
                continue;
            if (least > best_area) {
                best_area = least;
                best = h;
            }
        }
        if (best < 0) return false;
        const int g = twin_[at(best)];
        flip(best);
        for (const int e : {best, Topology::next(best), Topology::previous(best), g,
                            Topology::next(g), Topology::previous(g)}) {
            touch(e);
        }
    }
    return false;
}

void ConeTriangulation::compact() {
    std::vector<int> number(is_dead_.size(), -1);
    int count = 0;
    for (std::size_t t = 0; t < is_dead_.size(); ++t) {
        if (is_dead_[t]) continue;
        const int kept = count++;
        number[t] = kept;
        for (int k = 0; k < 3; ++k) {
            const std::size_t from = 3 * t + at(k);
            const std::size_t to = at(3 * kept + k);
            origin_[to] = origin_[from];
            twin_[to] = twin_[from];
            rotation_[to] = rotation_[from];
            displacement_[to] = displacement_[from];
            if (to != from) rows_[to] = std::move(rows_[from]);
            if (rows_[to].cols() == 0) rows_[to] = Rows::Zero(2, integers_.size());
        }
    }
    const std::size_t corners = at(3 * count);
    origin_.resize(corners);
    twin_.resize(corners);
    rotation_.resize(corners);
    displacement_.resize(corners);
    rows_.resize(corners);
    // Moves copy what is left: let go of the room that the mesh took.
    rows_.shrink_to_fit();
    for (int& h : twin_) {
        if (h >= 0) h = 3 * number[at(h / 3)] + h % 3;
    }
    is_dead_.assign(at(count), 0);
    alive_.resize(at(count));
    std::iota(alive_.begin(), alive_.end(), 0);
}

double ConeTriangulation::determinant(int i) const {
    const int h = 3 * alive_[at(i)];
    return cross(displacement_[at(h)], displacement_[at(h + 1)]);
}

Eigen::VectorXd ConeTriangulation::determinant_gradient(int i) const {
    const int h = 3 * alive_[at(i)];
    const Complex a = displacement_[at(h)];
    const Complex b = displacement_[at(h + 1)];
    const auto part = [&](int slot, int k) {
        return rows_[at(slot)].row(k).cast<double>().transpose();
    };
    return b.imag() * part(h, 0) + a.real() * part(h + 1, 1) - b.real() * part(h, 1) -
           a.imag() * part(h + 1, 0);
}

std::vector<int> ConeTriangulation::short_edges(double length) const {
    std::vector<int> found;
    for (const int t : alive_) {
        for (int h = 3 * t; h < 3 * t + 3; ++h) {
            if (twin_[at(h)] < h && std::norm(displacement_[at(h)]) < length * length)
                found.push_back(h);
        }
    }
    return found;
}

double ConeTriangulation::edge_length(int half_edge) const {
    return std::abs(displacement_[at(half_edge)]);
}

Eigen::VectorXd ConeTriangulation::edge_length_gradient(int half_edge) const {
    const Complex d = displacement_[at(half_edge)] / edge_length(half_edge);
    const Rows& rows = rows_[at(half_edge)];
    return d.real() * rows.row(0).cast<double>().transpose() +
           d.imag() * rows.row(1).cast<double>().transpose();
}

double ConeTriangulation::area() const {
    double sum = 0;
    for (int i = 0; i < triangle_count(); ++i) sum += determinant(i);
    return sum / 2;
}

bool ConeTriangulation::move(const Eigen::VectorXd& step) {
    std::vector<int> flips;
    const auto velocity_of = [&](int h) { return rows_times(rows_[at(h)], step); };
    std::vector<Complex> velocity(displacement_.size());
    for (const int t : alive_) {
        for (int h = 3 * t; h < 3 * t + 3; ++h) velocity[at(h)] = velocity_of(h);
    }
    const auto finish = [&](const Eigen::VectorXd& y) { snap(y); };
    const auto undo = [&] {
        // Four flips of one half-edge are the identity, so three undo one.
        for (auto h = flips.rbegin(); h != flips.rend(); ++h) {
            for (int i = 0; i < 3; ++i) flip(*h);
        }
        finish(integers_);
        return false;
    };
    /// Time until the triangle's area vanishes, while it shrinks.
    const auto time_to_collapse = [&](int t) {
        const auto h = at(3 * t);
        const double c0 = cross(displacement_[h], displacement_[h + 1]);
        const double c1 =
            cross(velocity[h], displacement_[h + 1]) + cross(displacement_[h], velocity[h + 1]);
        const double c2 = cross(velocity[h], velocity[h + 1]);
        if (c0 <= no_area) {
            if (c1 < 0 || (c1 <= 1e-12 && c2 < 0)) return 0.0;
            if (c2 >= 0 || c1 <= 0) return std::numeric_limits<double>::infinity();
            return -c1 / c2;
        }
        if (std::abs(c2) < 1e-14 * std::max(c0, std::abs(c1))) {
            return c1 < 0 ? -c0 / c1 : std::numeric_limits<double>::infinity();
        }
        // Two roots that meet are a collapse too: nodes that pass through one another.
        const double discriminant = c1 * c1 - 4 * c0 * c2;
        if (discriminant < -1e-12 * c1 * c1) return std::numeric_limits<double>::infinity();
        const double q = -0.5 * (c1 + std::copysign(std::sqrt(std::max(0.0, discriminant)), c1));
        double best = std::numeric_limits<double>::infinity();
        for (const double root : {q / c2, q != 0 ? c0 / q : -1.0}) {
            if (root >= 0) best = std::min(best, root);
        }
        return best;
    };
    double left = 1;
    const int most_flips = 20 * triangle_count() + 20;
    while (true) {
        int first = -1;
        double soonest = std::numeric_limits<double>::infinity();
        for (const int t : alive_) {
            const double time = time_to_collapse(t);
            if (time < soonest) {
                soonest = time;
                first = t;
            }
        }
        if (soonest > left * (1 + 1e-12)) break;
        const double advance = std::min(soonest, left);
        for (const int t : alive_) {
            for (int h = 3 * t; h < 3 * t + 3; ++h)
                displacement_[at(h)] += advance * velocity[at(h)];
        }
        left -= advance;
        int longest = 3 * first;
        for (int h = 3 * first; h < 3 * first + 3; ++h) {
            if (std::abs(displacement_[at(h)]) > std::abs(displacement_[at(longest)])) longest = h;
        }
        // The apex has to lie strictly within the edge it ran into.
        if (!can_flip(longest, 1e-7) || static_cast<int>(flips.size()) >= most_flips) return undo();
        const int other = twin_[at(longest)];
        flip(longest);
        flips.push_back(longest);
        for (const int t : {longest / 3, other / 3}) {
            for (int h = 3 * t; h < 3 * t + 3; ++h) velocity[at(h)] = velocity_of(h);
        }
    }
    const Eigen::VectorXd before = integers_;
    finish(integers_ + step);
    for (int i = 0; i < triangle_count(); ++i) {
        if (determinant(i) <= no_area) {
            integers_ = before;
            return undo();
        }
    }
    make_delaunay();
    return true;
}

}  // namespace kinequad
