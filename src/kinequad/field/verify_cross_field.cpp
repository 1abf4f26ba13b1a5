#include "kinequad/field/verify_cross_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinequad/core/index.h"
#include "kinequad/field/field_problem.h"
#include "kinequad/field/singularities.h"

namespace kinequad {
namespace {

constexpr double tolerance = 1e-6;

double distance_to_quarters(double angle) {
    return std::abs(angle - quarter * nearest_quarter(angle));
}

}  // namespace

bool CrossFieldReport::valid() const {
    return finite && index_sum == expected_index_sum && wrong_indices == 0 &&
           broken_holonomies == 0 && periods_on_boundary == 0 && unaligned_triangles == 0;
}

CrossFieldReport verify_cross_field(const Topology& topology, const IntrinsicMetric& metric,
                                    const CrossField& field, const CrossFieldOptions& options) {
    CrossFieldReport report;
    report.expected_index_sum = 4 * count_surface(topology).euler_characteristic;
    report.index_sum = field.index.sum();
    report.finite = field.angle.allFinite();
    if (!report.finite) return report;

    const FieldProblem problem = make_field_problem(topology, metric, {}, options);
    for (int t = 0; t < problem.triangle_count; ++t) {
        if (problem.fixed[at(t)] &&
            distance_to_quarters(field.angle[t] - problem.fixed_angle[t]) > tolerance) {
            ++report.unaligned_triangles;
        }
    }
    const Eigen::VectorXd residual = edge_residuals(problem, {field.angle, field.period_jump});
    Eigen::VectorXd holonomy = problem.defect;
    for (int e = 0; e < problem.edge_count; ++e) {
        holonomy[problem.tail[at(e)]] += residual[e];
        holonomy[problem.head[at(e)]] -= residual[e];
        if (problem.right[at(e)] < 0) {
            if (field.period_jump[e] != 0) ++report.periods_on_boundary;
            continue;
        }
        report.largest_residual = std::max(report.largest_residual, std::abs(residual[e]));
        if (std::abs(residual[e]) > quarter / 2) ++report.large_residuals;
    }
    for (int v = 0; v < problem.vertex_count; ++v) {
        if (distance_to_quarters(holonomy[v]) > tolerance) ++report.broken_holonomies;
        if (nearest_quarter(holonomy[v]) != field.index[v]) ++report.wrong_indices;
        if (field.index[v] >= (topology.is_boundary_vertex(v) ? 2 : 4)) ++report.angleless_vertices;
    }
    report.adjacent_singularities = count_adjacent_singularities(topology, field);
    return report;
}

}  // namespace kinequad
