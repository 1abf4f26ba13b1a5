#include "kinequad/gridmap/cone_triangulation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "kinequad/core/index.h"

namespace kinequad {
namespace {

/// The form whose parts are `u` and `v`.
PlaneForm plane_form(const LinearForm<long>& u, const LinearForm<long>& v) {
    PlaneForm first;
    PlaneForm second;
    for (const auto& [unknown, c] : u) first.terms.push_back({unknown, static_cast<int>(c), 0});
    for (const auto& [unknown, c] : v) second.terms.push_back({unknown, 0, static_cast<int>(c)});
    return first + second;
}

/// `u` times the first part plus `v` times the second, as a form.
LinearForm<double> product(const PlaneForm& form, double u, double v) {
    LinearForm<double> result;
    result.reserve(form.terms.size());
    for (const PlaneForm::Term& term : form.terms) {
        result.emplace_back(term.unknown, u * term.u + v * term.v);
    }
    return result;
}

}  // namespace

ConeTriangulation::ConeTriangulation(const ChartedMesh& mesh, const MapVariables& variables,
                                     const std::vector<Complex>& corners,
                                     const Eigen::VectorXd& integers)
    : origin_(mesh.origin),
      twin_(mesh.twin),
      rotation_(mesh.rotation),
      displacement_(mesh.origin.size()),
      form_(mesh.origin.size()),
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
        form_[h] = plane_form(row_of(end, 0), row_of(end, 1)) +
                   turn(plane_form(row_of(h, 0), row_of(h, 1)), 2);
    }
    for (int t = 0; t < static_cast<int>(is_dead_.size()); ++t) alive_.push_back(t);
    const std::vector<char> is_node = cut_lines(mesh, variables.is_node);
    make_delaunay();
    take_out_vertices(is_node);
    compact();
    // What is left joins nodes only: its displacements follow from y alone, without drift.
    snap(integers);
    make_delaunay();
}

/// Turns lines into two boundaries each, every vertex on them into one vertex a side. Returns which
/// vertices are nodes then.
std::vector<char> ConeTriangulation::cut_lines(const ChartedMesh& mesh, std::vector<char> is_node) {
    bool has_lines = false;
    for (std::size_t h = 0; h < twin_.size(); ++h) {
        if (!mesh.is_line[h]) continue;
        twin_[h] = -1;
        has_lines = true;
    }
    is_on_line_.assign(is_node.size(), 0);
    if (!has_lines) return is_node;
    for (std::size_t h = 0; h < twin_.size(); ++h) {
        if (mesh.is_line[h]) is_on_line_[at(origin_[h])] = 1;
    }
    std::vector<char> is_visited(origin_.size(), 0);
    std::vector<char> is_taken(is_node.size(), 0);
    for (std::size_t h = 0; h < origin_.size(); ++h) {
        if (is_visited[h]) continue;
        const int v = origin_[h];
        int number = v;
        if (is_taken[at(v)]) {
            number = static_cast<int>(is_node.size());
            is_node.push_back(is_node[at(v)]);
            is_on_line_.push_back(is_on_line_[at(v)]);
        } else {
            is_taken[at(v)] = 1;
        }
        bool is_open = false;
        for (const int corner : star(static_cast<int>(h), is_open)) {
            is_visited[at(corner)] = 1;
            origin_[at(corner)] = number;
        }
    }
    return is_node;
}

void ConeTriangulation::snap(const Eigen::VectorXd& integers) {
    integers_ = integers;
    for (const int t : alive_) {
        for (int h = 3 * t; h < 3 * t + 3; ++h) displacement_[at(h)] = form_[at(h)].at(integers);
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
    return cross_product(ca, ad) > least && cross_product(db, bc) > least;
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
        PlaneForm form;
    };
    const auto side = [&](int old_slot, int new_slot, int turns) {
        return Side{old_slot,
                    new_slot,
                    turns,
                    twin_[at(old_slot)],
                    rotation_[at(old_slot)],
                    turn(displacement_[at(old_slot)], turns),
                    turn(form_[at(old_slot)], turns)};
    };
    std::array<Side, 4> sides = {side(hn, hp, 0), side(hp, gn, r), side(gn, gp, 0),
                                 side(gp, hn, -r)};

    const Complex cd = displacement_[at(hp)] + turn(displacement_[at(gn)], -r);
    PlaneForm cd_form = form_[at(hp)] + turn(form_[at(gn)], -r);
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
        form_[at(s.new_slot)] = std::move(s.form);
    }
    displacement_[at(h)] = cd;
    displacement_[at(g)] = turn(-cd, r);
    form_[at(g)] = turn(cd_form, r + 2);
    form_[at(h)] = std::move(cd_form);
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
        const double area = cross_product(displacement_[at(h)], -right);
        return std::real(std::conj(left) * right) / std::max(area, 1e-300);
    };
    const std::size_t most = 50 * queue.size() + 1000;
    for (std::size_t i = 0; i < queue.size() && i < most; ++i) {
        const int h = queue[i];
        const int g = twin_[at(h)];
        if (g < 0 || is_dead_[at(h / 3)]) continue;
        if (opposite_cotangent(h) + opposite_cotangent(g) > -1e-9 || !can_flip(h, least_cone_area))
            continue;
        flip(h);
        for (const int e :
             {Topology::next(h), Topology::previous(h), Topology::next(g), Topology::previous(g)}) {
            queue.push_back(e);
        }
    }
}

double ConeTriangulation::determinant(int i) const {
    const int h = 3 * alive_[at(i)];
    return cross_product(displacement_[at(h)], displacement_[at(h + 1)]);
}

LinearForm<double> ConeTriangulation::determinant_gradient(int i) const {
    const int h = 3 * alive_[at(i)];
    const Complex a = displacement_[at(h)];
    const Complex b = displacement_[at(h + 1)];
    // det = a.u b.v - a.v b.u
    return add_scaled(product(form_[at(h)], b.imag(), -b.real()), 1.0,
                      product(form_[at(h + 1)], -a.imag(), a.real()));
}

std::vector<int> ConeTriangulation::edges() const {
    std::vector<int> found;
    for (const int t : alive_) {
        for (int h = 3 * t; h < 3 * t + 3; ++h) {
            if (twin_[at(h)] < h) found.push_back(h);
        }
    }
    return found;
}

double ConeTriangulation::edge_length(int half_edge) const {
    return std::abs(displacement_[at(half_edge)]);
}

LinearForm<double> ConeTriangulation::edge_length_gradient(int half_edge) const {
    const Complex direction = displacement_[at(half_edge)] / edge_length(half_edge);
    return product(form_[at(half_edge)], direction.real(), direction.imag());
}

std::vector<int> ConeTriangulation::overlooked_lines() const {
    std::vector<int> found;
    for (const int t : alive_) {
        for (int h = 3 * t; h < 3 * t + 3; ++h) {
            const bool is_on_line = twin_[at(h)] < 0 && is_on_line_[at(origin_[at(h)])] &&
                                    is_on_line_[at(origin_[at(Topology::next(h))])];
            if (!is_on_line) continue;
            const Complex base = displacement_[at(h)];
            const Complex to_apex = -displacement_[at(Topology::previous(h))];
            const double foot = std::real(std::conj(base) * to_apex);
            if (foot >= 0 && foot <= std::norm(base)) found.push_back(h);
        }
    }
    return found;
}

double ConeTriangulation::height(int half_edge) const {
    return determinant(half_edge / 3) / edge_length(half_edge);
}

LinearForm<double> ConeTriangulation::height_gradient(int half_edge) const {
    const double length = edge_length(half_edge);
    LinearForm<double> gradient = add_scaled(determinant_gradient(half_edge / 3),
                                             -height(half_edge), edge_length_gradient(half_edge));
    for (auto& [unknown, c] : gradient) c /= length;
    return gradient;
}

bool ConeTriangulation::is_loop(int half_edge) const {
    return origin_[at(half_edge)] == origin_[at(Topology::next(half_edge))];
}

int ConeTriangulation::boundary_loop_size(int half_edge) const {
    if (twin_[at(half_edge)] >= 0) return 0;
    int size = 0;
    int h = half_edge;
    do {
        ++size;
        // The next boundary edge: turn about the end of this one.
        h = Topology::next(h);
        while (twin_[at(h)] >= 0) h = Topology::next(twin_[at(h)]);
    } while (h != half_edge);
    return size;
}

double ConeTriangulation::area() const {
    double sum = 0;
    for (int i = 0; i < triangle_count(); ++i) sum += determinant(i);
    return sum / 2;
}

}  // namespace kinequad
