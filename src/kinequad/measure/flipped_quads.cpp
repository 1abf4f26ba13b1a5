#include "kinequad/measure/flipped_quads.h"

#include <Eigen/Geometry>
#include <vector>

#include "kinequad/core/index.h"
#include "kinequad/core/parallel.h"
#include "kinequad/measure/triangulation.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {
namespace {

/// Product of the normals of a quad and of the input below it; its sign says whether they agree.
double agreement(const Positions& X, const Polygons& faces, int f, const ClosestPoints& input,
                 int hint) {
    const auto corner = [&](int k) -> Vector3 { return X.row(vertex_of(faces, f, k)).transpose(); };
    const Vector3 center = (corner(0) + corner(1) + corner(2) + corner(3)) / 4;
    const Vector3 normal = (corner(2) - corner(0)).cross(corner(3) - corner(1));
    const int below = input.find(center, hint).point.triangle;
    return normal.dot(triangle_area_vector(input.positions(), input.triangles(), below));
}

}  // namespace

int count_flipped_quads(const Positions& X, const Polygons& faces, const ClosestPoints& input,
                        const std::vector<int>& hints, const Context& context) {
    std::vector<double> sign(static_cast<std::size_t>(faces.count()), 0);
    parallel_for(sign.size(), 256, context, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const int f = static_cast<int>(i);
            if (degree_of(faces, f) != 4) continue;
            const auto corner = static_cast<std::size_t>(vertex_of(faces, f, 0));
            sign[i] = agreement(X, faces, f, input, hints.empty() ? -1 : hints[corner]);
        }
    });
    int quads = 0;
    int against = 0;
    int along = 0;
    for (int f = 0; f < faces.count(); ++f) {
        if (degree_of(faces, f) != 4) continue;
        ++quads;
        if (sign[at(f)] < 0) ++against;
        if (sign[at(f)] > 0) ++along;
    }
    return 2 * against > quads ? along : against;
}

}  // namespace kinequad
