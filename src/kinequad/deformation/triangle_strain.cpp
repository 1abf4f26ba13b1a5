#include "kinequad/deformation/triangle_strain.h"

#include "kinequad/core/index.h"

namespace kinequad {

std::vector<RestTriangle> rest_triangles(const Topology& topology, const IntrinsicMetric& metric) {
    std::vector<RestTriangle> result(static_cast<std::size_t>(topology.triangle_count));
    for (int t = 0; t < topology.triangle_count; ++t) {
        const Eigen::Matrix<double, 2, 3> corner =
            lay_out_triangle(side_lengths(topology, metric, t));
        const double base = corner(0, 1);
        const double height = corner(1, 2);
        // Thinner than this, the inverse is noise of the edge lengths.
        if (!(height > 1e-7 * base) || !(height > 1e-7 * std::abs(corner(0, 2)))) continue;
        result[at(t)] = {1 / base, -corner(0, 2) / (base * height), 1 / height};
    }
    return result;
}

}  // namespace kinequad
