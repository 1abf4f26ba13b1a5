#include "kinequad/measure/triangulation.h"

#include <fmt/format.h>

#include "kinequad/core/error.h"

namespace kinequad {
void check_polygons(const Polygons& faces, int vertex_count) {
    require(faces.count() > 0, InputFault::mesh,
            "the mesh to measure has no face; give one with quads");
    for (int f = 0; f < faces.count(); ++f) {
        if (degree_of(faces, f) < 3) {
            throw InputError(InputFault::mesh, fmt::format("face {} has {} corners; remove it", f,
                                                           degree_of(faces, f)));
        }
        for (int k = 0; k < degree_of(faces, f); ++k) {
            const int v = vertex_of(faces, f, k);
            if (v < 0 || v >= vertex_count) {
                throw InputError(
                    InputFault::mesh,
                    fmt::format("face {} names vertex {}, but there are {} vertices; mend "
                                "the face list",
                                f, v, vertex_count));
            }
        }
    }
}

Triangulation triangulate_for_measuring(const Polygons& faces, const Positions& V) {
    Triangulation result;
    Eigen::Index count = 0;
    for (int f = 0; f < faces.count(); ++f) count += degree_of(faces, f) - 2;
    result.F.resize(count, 3);
    result.face.reserve(static_cast<std::size_t>(count));
    Eigen::Index t = 0;
    for (int f = 0; f < faces.count(); ++f) {
        const int degree = degree_of(faces, f);
        int start = 0;
        if (degree == 4) {
            const auto corner = [&](int k) { return V.row(vertex_of(faces, f, k)); };
            const double even = (corner(0) - corner(2)).squaredNorm();
            const double odd = (corner(1) - corner(3)).squaredNorm();
            start = even <= odd ? 0 : 1;
        }
        for (int k = 1; k + 1 < degree; ++k) {
            result.F.row(t++) << vertex_of(faces, f, start),
                vertex_of(faces, f, (start + k) % degree),
                vertex_of(faces, f, (start + k + 1) % degree);
            result.face.push_back(f);
        }
    }
    return result;
}

}  // namespace kinequad
