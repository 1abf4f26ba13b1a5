#include "kinequad/measure/quad_shape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "kinequad/core/index.h"
#include "kinequad/measure/triangulation.h"

namespace kinequad {

QuadShapeMetrics measure_shape(const Positions& V, const Polygons& faces) {
    QuadShapeMetrics metrics;
    double deviation_sum = 0;
    double jacobian_sum = 0;
    double jacobian_min = std::numeric_limits<double>::infinity();
    int count = 0;
    for (int f = 0; f < faces.count(); ++f) {
        if (degree_of(faces, f) != 4) continue;
        ++count;
        std::array<Vector3, 4> corner;
        for (int k = 0; k < 4; ++k) {
            corner[at(k)] = V.row(vertex_of(faces, f, k)).transpose();
        }
        const Vector3 vector_area = (corner[2] - corner[0]).cross(corner[3] - corner[1]);
        const Vector3 normal = vector_area / vector_area.norm();
        double worst = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < 4; ++k) {
            const Vector3 next = corner[(k + 1) % 4] - corner[k];
            const Vector3 previous = corner[(k + 3) % 4] - corner[k];
            const double lengths = next.norm() * previous.norm();
            const double cosine = next.dot(previous) / lengths;
            const double angle = std::isfinite(cosine) ? std::acos(std::clamp(cosine, -1.0, 1.0)) *
                                                             (180 / std::numbers::pi)
                                                       : 0;
            const double deviation = std::abs(angle - 90);
            deviation_sum += deviation;
            metrics.angle_deviation_max = std::max(metrics.angle_deviation_max, deviation);
            const double jacobian = next.cross(previous).dot(normal) / lengths;
            worst = std::min(worst, std::isfinite(jacobian) ? jacobian : -1);
        }
        jacobian_sum += worst;
        jacobian_min = std::min(jacobian_min, worst);
        if (worst <= 0) ++metrics.folded_quads;
    }
    if (count == 0) return metrics;
    metrics.angle_deviation_mean = deviation_sum / (4.0 * count);
    metrics.scaled_jacobian_min = jacobian_min;
    metrics.scaled_jacobian_mean = jacobian_sum / count;
    return metrics;
}

QuadShapeMetrics measure_shape(const Positions& V, const Quads& Q) {
    return measure_shape(V, make_polygons(Q));
}

}  // namespace kinequad
