#include "kinequad/field/refine_cross_field.h"

#include <cmath>
#include <complex>
#include <numbers>

#include "kinequad/core/index.h"
#include "kinequad/field/field_problem.h"

namespace kinequad {
namespace {

/// The half-edge of the parent that half-edge `h` of the refined mesh lies on, -1 inside.
int half_edge_of_parent(const RefinedMesh& fine, int h) {
    const auto a = fine.barycentric.row(h);
    const auto b = fine.barycentric.row(Topology::next(h));
    for (int k = 0; k < 3; ++k) {
        if (a[k] == 0 && b[k] == 0) return 3 * fine.parent[at(h / 3)] + (k + 1) % 3;
    }
    return -1;
}

/// Angle of the first side of triangle `t` of the refined mesh in the frame of its parent.
double turn_from_parent(const RefinedMesh& fine, int t, const Topology& topology,
                        const IntrinsicMetric& metric) {
    const auto layout = lay_out_triangle(side_lengths(topology, metric, fine.parent[at(t)]));
    const Eigen::Index corner = Eigen::Index{3} * t;
    const Vector2 axis =
        layout * (fine.barycentric.row(corner + 1) - fine.barycentric.row(corner)).transpose();
    return std::atan2(axis[1], axis[0]);
}

}  // namespace

CrossField refine_cross_field(const CrossField& field, const Topology& topology,
                              const IntrinsicMetric& metric, const RefinedMesh& fine,
                              const Topology& fine_topology, const IntrinsicMetric& fine_metric) {
    CrossField result;
    result.energy = field.energy;
    result.angle.resize(fine_topology.triangle_count);
    for (int t = 0; t < fine_topology.triangle_count; ++t) {
        result.angle[t] =
            field.angle[fine.parent[at(t)]] - turn_from_parent(fine, t, topology, metric);
    }
    result.period_jump = Eigen::VectorXi::Zero(fine_topology.edge_count);
    for (int e = 0; e < fine_topology.edge_count; ++e) {
        const int h = fine_topology.edge_half_edge[at(e)];
        const int other = fine_topology.twin[at(h)];
        if (other < 0) continue;
        double wanted = 0;
        const int coarse = half_edge_of_parent(fine, h);
        if (coarse >= 0 && fine.parent[at(h / 3)] != fine.parent[at(other / 3)]) {
            const int edge = topology.edge[at(coarse)];
            const int lower = topology.edge_half_edge[at(edge)];
            const double residual =
                field.angle[lower / 3] + frame_rotation(topology, metric, lower) +
                quarter * field.period_jump[edge] - field.angle[topology.twin[at(lower)] / 3];
            wanted = coarse == lower ? residual : -residual;
        }
        const double without = result.angle[h / 3] + frame_rotation(fine_topology, fine_metric, h) -
                               result.angle[other / 3];
        result.period_jump[e] = nearest_quarter(wanted - without);
    }
    result.index = Eigen::VectorXi::Zero(fine_topology.vertex_count);
    result.index.head(field.index.size()) = field.index;
    return result;
}

CrossFieldTargets refine_targets(const CrossFieldTargets& targets, const Topology& topology,
                                 const IntrinsicMetric& metric, const RefinedMesh& fine) {
    const int triangles = static_cast<int>(fine.parent.size());
    CrossFieldTargets result{Eigen::VectorXcd(triangles), Eigen::VectorXd(triangles)};
    for (int t = 0; t < triangles; ++t) {
        const int parent = fine.parent[at(t)];
        const double turn = turn_from_parent(fine, t, topology, metric);
        result.value[t] = targets.value[parent] * std::polar(1.0, -4 * turn);
        result.weight[t] = targets.weight[parent];
    }
    return result;
}

}  // namespace kinequad
