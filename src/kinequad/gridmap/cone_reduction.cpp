// Taking the vertices of a mesh that are no nodes out of its cone metric.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/gridmap/cone_triangulation.h"

namespace kinequad {
namespace {}  // namespace

void ConeTriangulation::take_out_vertices(const std::vector<char>& is_node) {
    const int vertex_count = static_cast<int>(is_node.size());
    std::vector<int> outgoing(is_node.size(), -1);
    const auto refresh = [&] {
        std::fill(outgoing.begin(), outgoing.end(), -1);
        for (int h = 0; h < static_cast<int>(origin_.size()); ++h) {
            if (!is_dead_[at(h / 3)]) outgoing[at(origin_[at(h)])] = h;
        }
    };
    refresh();
    std::vector<int> left;
    for (int v = 0; v < vertex_count; ++v) {
        if (!is_node[at(v)] && outgoing[at(v)] >= 0) left.push_back(v);
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

std::vector<int> ConeTriangulation::star(int start, bool& is_open) const {
    is_open = false;
    for (int h = start;;) {
        const int g = twin_[at(h)];
        if (g < 0) {
            start = h;
            is_open = true;
            break;
        }
        h = Topology::next(g);
        if (h == start) break;
    }
    std::vector<int> fan;
    for (int h = start;;) {
        fan.push_back(h);
        h = twin_[at(Topology::previous(h))];
        if (h < 0 || h == start) break;
    }
    return fan;
}

/// Merges the star of a vertex with three triangles, two on the boundary, into the triangle of its
/// first half-edge.
void ConeTriangulation::merge_star(const std::vector<int>& fan, bool is_open,
                                   std::vector<int>& outgoing) {
    struct Side {
        int origin;
        int twin;
        int rotation;
        Complex displacement;
        PlaneForm form;
    };
    const int keep = fan[0];
    const int t = keep / 3;
    const int v = origin_[at(keep)];
    std::vector<int> outer;
    std::vector<int> to_keep;
    std::vector<Side> sides;
    int turns = 0;
    for (std::size_t i = 0; i < fan.size(); ++i) {
        if (i > 0) turns += rotation_[at(fan[i])];
        const int s = Topology::next(fan[i]);
        outer.push_back(s);
        to_keep.push_back(turns);
        sides.push_back({origin_[at(s)], twin_[at(s)], rotation_[at(s)] - turns,
                         turn(displacement_[at(s)], turns), turn(form_[at(s)], turns)});
    }
    if (is_open) {
        // The two boundary edges at v lie on one line and become one.
        const int in = Topology::previous(fan.back());
        sides.push_back({origin_[at(in)], -1, 0,
                         turn(displacement_[at(in)], turns) + displacement_[at(keep)],
                         turn(form_[at(in)], turns) + form_[at(keep)]});
    }
    // Sides glued to one another keep their glue in the merged numbering.
    for (Side& s : sides) {
        for (std::size_t j = 0; j < outer.size(); ++j) {
            if (s.twin != outer[j]) continue;
            s.twin = 3 * t + static_cast<int>(j);
            s.rotation += to_keep[j];
            break;
        }
    }
    for (std::size_t i = 1; i < fan.size(); ++i) is_dead_[at(fan[i] / 3)] = 1;
    for (std::size_t i = 0; i < 3; ++i) {
        const int slot = 3 * t + static_cast<int>(i);
        Side& s = sides[i];
        origin_[at(slot)] = s.origin;
        twin_[at(slot)] = s.twin;
        rotation_[at(slot)] = s.rotation & 3;
        displacement_[at(slot)] = s.displacement;
        form_[at(slot)] = std::move(s.form);
        if (s.twin >= 0) {
            twin_[at(s.twin)] = slot;
            rotation_[at(s.twin)] = -s.rotation & 3;
        }
        outgoing[at(s.origin)] = slot;
    }
    outgoing[at(v)] = -1;
}

/// The half-edge of the star of `v` whose flip leaves the fattest triangles behind, -1 where none
/// can be flipped. Just before v goes, it may lie on both diagonals of its neighbours: then a
/// triangle without area, which goes with it.
int ConeTriangulation::fattest_flip(int v, const std::vector<int>& fan) const {
    const bool is_last =
        fan.size() == 4 && std::none_of(fan.begin(), fan.end(), [&](int h) {
            return origin_[at(Topology::next(h))] == v || origin_[at(Topology::previous(h))] == v;
        });
    int best = -1;
    double best_area = is_last ? -1e-10 : 1e-14;
    for (const int h : fan) {
        const int g = twin_[at(h)];
        if (g < 0 || g / 3 == h / 3) continue;
        // The new edge must not end at v again.
        if (origin_[at(Topology::previous(h))] == v || origin_[at(Topology::previous(g))] == v)
            continue;
        const int r = rotation_[at(h)];
        const Complex ca = displacement_[at(Topology::previous(h))];
        const Complex bc = displacement_[at(Topology::next(h))];
        const Complex ad = turn(displacement_[at(Topology::next(g))], -r);
        const Complex db = turn(displacement_[at(Topology::previous(g))], -r);
        double least = std::min(cross_product(ca, ad), cross_product(db, bc));
        // An edge from v to itself counts twice: flip it first.
        if (origin_[at(g)] == v && least > 1e-14) least += 1e6;
        if (least > best_area) {
            best_area = least;
            best = h;
        }
    }
    return best;
}

bool ConeTriangulation::take_out(int v, std::vector<int>& outgoing) {
    constexpr int most_flips = 1000;
    for (int flips = 0; flips < most_flips; ++flips) {
        bool is_open = false;
        const std::vector<int> fan = star(outgoing[at(v)], is_open);
        const std::size_t wanted = is_open ? 2 : 3;
        if (fan.size() < wanted) return false;
        if (fan.size() == wanted) {
            const bool meets_itself = std::any_of(
                fan.begin(), fan.end(), [&](int h) { return origin_[at(Topology::next(h))] == v; });
            if (meets_itself || (is_open && origin_[at(Topology::previous(fan.back()))] == v))
                return false;
            merge_star(fan, is_open, outgoing);
            return true;
        }
        const int h = fattest_flip(v, fan);
        if (h < 0) return false;
        const int g = twin_[at(h)];
        flip(h);
        for (const int e : {h, Topology::next(h), Topology::previous(h), g, Topology::next(g),
                            Topology::previous(g)}) {
            outgoing[at(origin_[at(e)])] = e;
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
            if (to != from) form_[to] = std::move(form_[from]);
        }
    }
    const std::size_t corners = at(3 * count);
    origin_.resize(corners);
    twin_.resize(corners);
    rotation_.resize(corners);
    displacement_.resize(corners);
    form_.resize(corners);
    // Moves copy what is left: let go of the room that the mesh took.
    form_.shrink_to_fit();
    for (int& h : twin_) {
        if (h >= 0) h = 3 * number[at(h / 3)] + h % 3;
    }
    is_dead_.assign(at(count), 0);
    alive_.resize(at(count));
    std::iota(alive_.begin(), alive_.end(), 0);
}

}  // namespace kinequad
