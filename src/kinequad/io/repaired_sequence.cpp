#include "kinequad/io/repaired_sequence.h"

#include <algorithm>
#include <cmath>

#include "kinequad/core/index.h"
#include "kinequad/mesh/flat_triangles.h"

namespace kinequad {
namespace {

/// Takes away what has extent in the pose `V`, and adds the lengths there.
void add_frame(const Triangles& F, const Positions& V, MeshDegeneracies& degeneracies) {
    for (int t = 0; t < F.rows(); ++t) {
        const auto i = static_cast<std::size_t>(t);
        degeneracies.is_flat[i] =
            static_cast<char>(degeneracies.is_flat[i] != 0 && is_flat_triangle(F, V, t));
        for (int k = 0; k < 3; ++k) {
            const std::size_t h = 3 * i + static_cast<std::size_t>(k);
            const double length = (V.row(F(t, k)) - V.row(F(t, (k + 1) % 3))).stableNorm();
            degeneracies.length[h] += length;
            if (length > 0) degeneracies.is_point[h] = 0;
        }
    }
}

MeshDegeneracies find_degeneracies(const FrameSource& source, const Context& context) {
    const Triangles& F = source.triangles();
    const auto m = static_cast<std::size_t>(F.rows());
    MeshDegeneracies degeneracies{std::vector<char>(m, 1), std::vector<char>(3 * m, 1),
                                  std::vector<double>(3 * m, 0)};
    if (F.size() > 0 && (F.minCoeff() < 0 || F.maxCoeff() >= source.vertex_count())) {
        return degeneracies;
    }
    for (int frame = 0; frame < source.frame_count(); ++frame) {
        context.check_cancelled();
        add_frame(F, source.read_frame(frame), degeneracies);
    }
    if (source.has_rest_shape()) add_frame(F, source.read_rest_shape(), degeneracies);
    return degeneracies;
}

}  // namespace

RepairedSequence::RepairedSequence(const FrameSource& source, const Context& context)
    : source_(source),
      repair_(repair_mesh(source.triangles(), source.vertex_count(),
                          find_degeneracies(source, context))) {}

Positions RepairedSequence::extend(Positions V) const {
    const auto copies = static_cast<Eigen::Index>(repair_.copied_vertices.size());
    const Eigen::Index n = V.rows();
    V.conservativeResize(n + copies, 3);
    for (Eigen::Index i = 0; i < copies; ++i) {
        V.row(n + i) = V.row(repair_.copied_vertices[at(i)]);
    }
    return V;
}

Triangles RepairedSequence::input_triangles() const {
    Triangles F = repair_.F;
    const int n = source_.vertex_count();
    for (Eigen::Index i = 0; i < F.size(); ++i) {
        int& v = F.data()[i];
        if (v >= n) v = repair_.copied_vertices[at(v - n)];
    }
    return F;
}

}  // namespace kinequad
