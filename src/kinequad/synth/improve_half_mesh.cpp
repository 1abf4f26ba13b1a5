#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "kinequad/core/index.h"
#include "kinequad/core/parallel.h"
#include "kinequad/mesh/topology.h"
#include "kinequad/synth/half_mesh.h"

namespace kinequad::synth_detail {
namespace {

Triangles as_matrix(const std::vector<std::array<int, 3>>& triangles) {
    Triangles F(static_cast<Eigen::Index>(triangles.size()), 3);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            F(static_cast<Eigen::Index>(t), static_cast<Eigen::Index>(k)) = triangles[t][k];
        }
    }
    return F;
}

/// A half mesh whose edges can be flipped.
class Flipper {
public:
    Flipper(HalfMesh& mesh, const std::vector<int>& twin) : mesh_(mesh), twin_(twin) {}

    /// Flips each edge once where the sum of the opposite angles is above pi; returns how many.
    int pass() {
        int flips = 0;
        for (std::size_t h = 0; h < twin_.size(); ++h) {
            const int half_edge = static_cast<int>(h);
            if (twin_[h] > half_edge && should_flip(half_edge)) {
                flip(half_edge);
                ++flips;
            }
        }
        return flips;
    }

    const std::vector<int>& twin() const { return twin_; }

private:
    int& corner(int half_edge) { return mesh_.triangles[at(half_edge / 3)][at(half_edge % 3)]; }
    const Vector3& place(int vertex) const { return mesh_.vertices[at(vertex)]; }
    bool in_plane(int vertex) const { return mesh_.in_plane[at(vertex)] != 0; }
    int& twin_of(int half_edge) { return twin_[at(half_edge)]; }

    bool should_flip(int h) {
        const int g = twin_of(h);
        const int a = corner(h);
        const int b = corner(Topology::next(h));
        const int c = corner(Topology::previous(h));
        const int d = corner(Topology::previous(g));
        if (in_plane(c) && in_plane(d)) return false;
        const Vector3 ca = place(a) - place(c);
        const Vector3 cb = place(b) - place(c);
        const Vector3 da = place(a) - place(d);
        const Vector3 db = place(b) - place(d);
        const Vector3 first = ca.cross(cb);
        const Vector3 second = db.cross(da);
        // Sine of the sum of the two angles, without their sines' common length.
        const double sine = ca.dot(cb) * second.norm() + da.dot(db) * first.norm();
        const double size = ca.norm() * cb.norm() * da.norm() * db.norm();
        if (sine >= -1e-6 * size) return false;
        const Vector3 normal = first.normalized() + second.normalized();
        const Vector3 cd = place(d) - place(c);
        const bool unfolded = ca.cross(cd).dot(normal) > 0 && cd.cross(cb).dot(normal) > 0;
        const bool bent = first.normalized().dot(second.normalized()) < 0.5;
        return unfolded && !bent && !joined(h, d);
    }

    /// Whether the corner opposite of `h` and `d` are joined already: a flip would double the edge.
    bool joined(int h, int d) {
        const int start = Topology::previous(h);
        for (const bool clockwise : {false, true}) {
            int here = start;
            do {
                if (corner(Topology::next(here)) == d || corner(Topology::previous(here)) == d) {
                    return true;
                }
                if (clockwise) {
                    here = twin_of(here);
                    if (here >= 0) here = Topology::next(here);
                } else {
                    here = twin_of(Topology::previous(here));
                }
            } while (here >= 0 && here != start);
            if (here == start) return false;
        }
        return false;
    }

    void link(int h, int g) {
        twin_of(h) = g;
        if (g >= 0) twin_of(g) = h;
    }

    void flip(int h) {
        const int g = twin_of(h);
        const int a = corner(h);
        const int b = corner(Topology::next(h));
        const int c = corner(Topology::previous(h));
        const int d = corner(Topology::previous(g));
        const int bc = twin_of(Topology::next(h));
        const int ca = twin_of(Topology::previous(h));
        const int ad = twin_of(Topology::next(g));
        const int db = twin_of(Topology::previous(g));
        const int t = h / 3 * 3;
        const int s = g / 3 * 3;
        mesh_.triangles[at(h / 3)] = {c, d, b};
        mesh_.triangles[at(g / 3)] = {d, c, a};
        link(t, s);
        link(t + 1, db);
        link(t + 2, bc);
        link(s + 1, ca);
        link(s + 2, ad);
    }

    HalfMesh& mesh_;
    std::vector<int> twin_;
};

/// Vertices moved along the surface halfway to the mean of their neighbours. In the plane, the
/// mirror images of neighbours take away what would lead out of it.
void relax(HalfMesh& mesh, const ImplicitBody& body, const Context& context) {
    const std::size_t n = mesh.vertices.size();
    std::vector<Vector3> sum(n, Vector3::Zero());
    std::vector<int> count(n, 0);
    for (const auto& triangle : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto v = static_cast<std::size_t>(triangle[k]);
            sum[v] +=
                mesh.vertices[at(triangle[(k + 1) % 3])] + mesh.vertices[at(triangle[(k + 2) % 3])];
            count[v] += 2;
        }
    }
    const std::vector<Vector3> before = mesh.vertices;
    parallel_for(n, 256, context, [&](std::size_t begin, std::size_t end) {
        Vector3 low = before[begin];
        Vector3 high = low;
        for (std::size_t v = begin; v < end; ++v) {
            low = low.cwiseMin(before[v]);
            high = high.cwiseMax(before[v]);
        }
        const auto selection = body.select(0.5 * (low + high), 0.6 * (high - low).norm() + 1e-3);
        for (std::size_t v = begin; v < end; ++v) {
            const bool in_plane = mesh.in_plane[v] != 0;
            Vector3 step = 0.6 * (sum[v] / count[v] - before[v]);
            Vector3 gradient = body.sample(before[v], selection).gradient;
            if (in_plane) {
                step.x() = 0;
                gradient.x() = 0;
            }
            step -= step.dot(gradient) / std::max(gradient.squaredNorm(), 1e-6) * gradient;
            mesh.vertices[v] = body.project(before[v] + step, in_plane, selection);
            if (!in_plane) {
                // A vertex off the plane may come near it but has to stay on its side.
                mesh.vertices[v].x() = std::max(mesh.vertices[v].x(), 0.5 * before[v].x());
            }
        }
    });
}

}  // namespace

HalfMesh improve_half_mesh(const HalfMesh& mesh, const ImplicitBody& body, int rounds,
                           const Context& context) {
    HalfMesh improved = mesh;
    const Topology topology =
        build_topology(as_matrix(mesh.triangles), static_cast<int>(mesh.vertices.size()));
    Flipper flipper(improved, topology.twin);
    for (int round = 0; round < rounds; ++round) {
        context.check_cancelled();
        for (int pass = 0; pass < 3 && flipper.pass() > 0; ++pass) {
        }
        relax(improved, body, context);
    }
    for (int pass = 0; pass < 6 && flipper.pass() > 0; ++pass) {
    }
    return improved;
}

}  // namespace kinequad::synth_detail
