#include "kinequad/symmetry/weld_seams.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"

namespace kinequad {
namespace {

std::vector<int> unwelded(const Topology& topology) {
    std::vector<int> vertex(at(topology.vertex_count));
    std::iota(vertex.begin(), vertex.end(), 0);
    return vertex;
}

bool is_manifold(const TriangleMesh& mesh, const std::vector<int>& vertex) {
    Triangles F = mesh.F;
    for (Eigen::Index i = 0; i < F.size(); ++i) F.data()[i] = vertex[at(F.data()[i])];
    try {
        build_topology(F, static_cast<int>(mesh.V.rows()));
        return true;
    } catch (const InputError&) {
        return false;
    }
}

/// Joins boundary vertices that are the same numbers; what merely lies near is no seam.
std::vector<int> weld_places(const TriangleMesh& mesh, const Topology& topology) {
    std::vector<int> vertex = unwelded(topology);
    std::vector<int> border;
    for (int v = 0; v < topology.vertex_count; ++v) {
        if (topology.is_boundary_vertex(v)) border.push_back(v);
    }
    const auto place = [&](int v) { return std::array{mesh.V(v, 0), mesh.V(v, 1), mesh.V(v, 2)}; };
    std::stable_sort(border.begin(), border.end(),
                     [&](int a, int b) { return place(a) < place(b); });
    for (std::size_t i = 1; i < border.size(); ++i) {
        if (place(border[i]) == place(border[i - 1])) {
            vertex[at(border[i])] = vertex[at(border[i - 1])];
        }
    }
    return is_manifold(mesh, vertex) ? vertex : unwelded(topology);
}

/// A boundary loop that may be a seam, with its shape about its centre, scaled to perimeter 1.
struct SeamLoop {
    std::vector<int> half_edge;
    Positions shape;  ///< a row for the origin of every half-edge
    double perimeter = 0;
    Vector3 centre = Vector3::Zero();
    int component = 0;
};

std::vector<SeamLoop> collect_loops(const TriangleMesh& mesh, const Topology& topology) {
    const std::vector<int> component = triangle_components(topology);
    std::vector<SeamLoop> loops;
    for (std::vector<int>& chain : boundary_loops(topology)) {
        SeamLoop loop;
        loop.shape.resize(static_cast<Eigen::Index>(chain.size()), 3);
        Eigen::Index row = 0;
        for (const int h : chain) {
            const auto origin = mesh.V.row(topology.origin[at(h)]);
            loop.shape.row(row++) = origin;
            loop.perimeter += (mesh.V.row(topology.target(h)) - origin).norm();
        }
        loop.centre = loop.shape.colwise().mean().transpose();
        loop.shape.rowwise() -= loop.centre.transpose();
        if (loop.perimeter > 0) loop.shape /= loop.perimeter;
        loop.component = component[at(chain.front() / 3)];
        loop.half_edge = std::move(chain);
        loops.push_back(std::move(loop));
    }
    return loops;
}

/// `near` is a distance that parts which belong together may be apart, whatever their size.
bool may_meet(const SeamLoop& a, const SeamLoop& b, double near) {
    return a.half_edge.size() == b.half_edge.size() && a.component != b.component &&
           (a.centre - b.centre).norm() < std::max(near, std::min(a.perimeter, b.perimeter) / 2);
}

/// The loop nearest to loop `i` among those that it may meet; -1 where there is none.
int nearest_loop(const std::vector<SeamLoop>& loops, std::size_t i, double near) {
    int nearest = -1;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < loops.size(); ++j) {
        const double distance = (loops[i].centre - loops[j].centre).norm();
        if (!may_meet(loops[i], loops[j], near) || distance >= least) continue;
        least = distance;
        nearest = static_cast<int>(j);
    }
    return nearest;
}

/// Number of the half-edge of `b` that half-edge k of `a` lies along, backwards, when half-edge 0
/// lies along number `shift`.
std::size_t partner_of(std::size_t k, std::size_t shift, std::size_t count) {
    return (shift + count - k) % count;
}

/// The shift at which two loops differ least, or -1 where even then their shapes have little in
/// common.
int fit_loops(const SeamLoop& a, const SeamLoop& b) {
    const std::size_t count = a.half_edge.size();
    double least = 0.05;  // of the perimeter
    int best = -1;
    for (std::size_t shift = 0; shift < count; ++shift) {
        double difference = 0;
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t end = (partner_of(k, shift, count) + 1) % count;
            difference += (a.shape.row(static_cast<Eigen::Index>(k)) -
                           b.shape.row(static_cast<Eigen::Index>(end)))
                              .norm() /
                          static_cast<double>(count);
        }
        if (difference >= least) continue;
        least = difference;
        best = static_cast<int>(shift);
    }
    return best;
}

}  // namespace

std::vector<int> weld_seams(const TriangleMesh& mesh, const Topology& topology) {
    std::vector<int> vertex = weld_places(mesh, topology);
    std::vector<SeamLoop> loops = collect_loops(mesh, topology);
    const double near = 0.02 * bounding_box_diagonal(mesh.V);
    for (std::size_t i = 0; i < loops.size(); ++i) {
        const int j = nearest_loop(loops, i, near);
        if (j < 0 || nearest_loop(loops, at(j), near) != static_cast<int>(i)) continue;
        const int shift = fit_loops(loops[i], loops[at(j)]);
        if (shift < 0) continue;
        std::vector<int> trial = vertex;
        const std::size_t count = loops[i].half_edge.size();
        for (std::size_t k = 0; k < count; ++k) {
            const int other = loops[at(j)].half_edge[partner_of(k, at(shift), count)];
            const int a = trial[at(topology.origin[at(loops[i].half_edge[k])])];
            const int b = trial[at(topology.target(other))];
            for (int& v : trial) {
                if (v == std::max(a, b)) v = std::min(a, b);
            }
        }
        if (!is_manifold(mesh, trial)) continue;
        vertex = std::move(trial);
        // Joined components count as one: a second seam between them would make a handle.
        const int joined = loops[at(j)].component;
        for (SeamLoop& loop : loops) {
            if (loop.component == joined) loop.component = loops[i].component;
        }
    }
    return vertex;
}

}  // namespace kinequad
