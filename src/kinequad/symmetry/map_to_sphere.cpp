#include "kinequad/symmetry/map_to_sphere.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/symmetry/punctured_disk.h"

namespace kinequad {
namespace {

/// Vertices with triangles, in the order of `remoteness`.
std::vector<int> order_by_centrality(const Topology& topology,
                                     const std::vector<double>& remoteness) {
    std::vector<int> order;
    for (int v = 0; v < topology.vertex_count; ++v) {
        if (topology.vertex_half_edge[at(v)] >= 0) order.push_back(v);
    }
    std::sort(order.begin(), order.end(), [&](int a, int b) {
        return remoteness[at(a)] != remoteness[at(b)] ? remoteness[at(a)] < remoteness[at(b)]
                                                      : a < b;
    });
    return order;
}

int count_reversed(const Topology& topology, const SpherePoints& points) {
    int count = 0;
    for (std::size_t h = 0; h < topology.origin.size(); h += 3) {
        const RealVector3 a = points.row(topology.origin[h]).transpose();
        const RealVector3 b = points.row(topology.origin[h + 1]).transpose();
        const RealVector3 c = points.row(topology.origin[h + 2]).transpose();
        if (arc_side(a, b, c) <= 0) ++count;
    }
    return count;
}

/// A third of the areas of a vertex's triangles, as share of the whole.
Eigen::Matrix<Real, Eigen::Dynamic, 1> vertex_areas(const Topology& topology,
                                                    const IntrinsicMetric& metric) {
    const Eigen::VectorXd areas = triangle_areas(topology, metric);
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(topology.vertex_count);
    for (std::size_t h = 0; h < topology.origin.size(); ++h) {
        sum[topology.origin[h]] += areas[static_cast<Eigen::Index>(h / 3)];
    }
    return (sum / sum.sum()).cast<Real>();
}

/// Inverse stereographic projection from the south pole (which keeps the orientation seen from
/// outside), the plane first moved and scaled so that most of the area lies
/// in the unit disk.
SpherePoints wrap_plane(const Eigen::Matrix<Real, Eigen::Dynamic, 2>& z, int puncture,
                        const Eigen::Matrix<Real, Eigen::Dynamic, 1>& area) {
    const Eigen::Matrix<Real, 1, 2> mean = area.transpose() * z;
    const auto centred = (z.rowwise() - mean).eval();
    const Real scale = Real(1) / sqrt(area.dot(centred.rowwise().squaredNorm()));
    SpherePoints points(z.rows(), 3);
    for (Eigen::Index v = 0; v < z.rows(); ++v) {
        const Eigen::Matrix<Real, 1, 2> w = scale * centred.row(v);
        const Real square = w.squaredNorm();
        points.row(v) << 2 * w[0], 2 * w[1], 1 - square;
        points.row(v) /= square + 1;
    }
    points.row(puncture) << 0, 0, -1;
    return points;
}

/// Moves the centre of area to the centre of the sphere [Baden 2018].
void centre_points(SpherePoints& points, const Eigen::Matrix<Real, Eigen::Dynamic, 1>& area) {
    RealVector3 centre = (area.transpose() * points).transpose();
    for (int round = 0; round < 100 && centre.norm() > 1e-12; ++round) {
        Eigen::Matrix<Real, 3, 3> second = Eigen::Matrix<Real, 3, 3>::Zero();
        for (Eigen::Index v = 0; v < points.rows(); ++v) {
            second += area[v] * points.row(v).transpose() * points.row(v);
        }
        const Eigen::Matrix<Real, 3, 3> change = Eigen::Matrix<Real, 3, 3>::Identity() - second;
        const RealVector3 step = change.inverse() * centre;
        const Real length = step.norm();
        if (!(length > 0)) break;
        Real beta = std::min(length, Real(0.8));
        bool is_accepted = false;
        for (; beta > 1e-14 && !is_accepted; beta /= 2) {
            SpherePoints trial = points;
            boost_points(trial, step / length, beta);
            const RealVector3 there = (area.transpose() * trial).transpose();
            if (there.norm() < centre.norm()) {
                points = std::move(trial);
                centre = there;
                is_accepted = true;
            }
        }
        if (!is_accepted) break;
    }
}

}  // namespace

void boost_points(SpherePoints& points, const RealVector3& direction, Real beta) {
    const Real gamma = Real(1) / sqrt(Real(1) - beta * beta);
    for (Eigen::Index v = 0; v < points.rows(); ++v) {
        const RealVector3 x = points.row(v).transpose();
        const Real along = x.dot(direction);
        const RealVector3 moved =
            (x + (gamma * (along - beta) - along) * direction) / (gamma * (1 - beta * along));
        points.row(v) = moved.normalized().transpose();
    }
}

SphereMap map_to_sphere(const Topology& topology, const IntrinsicMetric& metric,
                        const std::vector<double>& remoteness, const Context& context) {
    const std::vector<int> order = order_by_centrality(topology, remoteness);
    FlipTriangulation delaunay = make_flip_triangulation(topology, metric);
    flip_to_delaunay(delaunay, Eigen::VectorXd::Ones(topology.vertex_count), FlipRule::euclidean);
    std::vector<int> leaving(at(topology.vertex_count), -1);
    for (std::size_t h = 0; h < delaunay.origin.size(); ++h) {
        leaving[at(delaunay.origin[h])] = static_cast<int>(h);
    }
    const auto area = vertex_areas(topology, metric);
    const auto finish = [&](const Eigen::Matrix<Real, Eigen::Dynamic, 2>& z, int puncture) {
        SphereMap map;
        map.points = wrap_plane(z, puncture, area);
        centre_points(map.points, area);
        map.reversed_triangles = count_reversed(topology, map.points);
        return map;
    };
    const int tolerated = std::max(2, topology.triangle_count / 500);
    SphereMap best;
    best.reversed_triangles = std::numeric_limits<int>::max();
    int tried = 0;
    int first = -1;
    for (const int v : order) {
        if (!has_good_star(delaunay, leaving[at(v)])) continue;
        if (first < 0) first = v;
        if (++tried > 4) break;
        PuncturedDisk disk = puncture_surface(delaunay, leaving[at(v)], topology.vertex_count);
        try {
            const Eigen::VectorXd u = flatten_disk(disk, context);
            SphereMap map = finish(lay_out_disk(disk, u, true), v);
            if (!map.points.allFinite()) continue;
            if (map.reversed_triangles < best.reversed_triangles) best = std::move(map);
            if (best.reversed_triangles <= tolerated) return best;
        } catch (const Error& error) {
            if (error.code() != ExitCode::internal_failure) throw;
        }
        context.write_log(LogLevel::debug, "symmetry: another puncture is tried");
    }
    if (best.points.rows() > 0) return best;
    context.write_log(LogLevel::warning,
                      "symmetry: no discrete conformal map was found; a harmonic one is used");
    const int pole = first >= 0 ? first : order.front();
    const PuncturedDisk disk = puncture_surface(delaunay, leaving[at(pole)], topology.vertex_count);
    SphereMap map =
        finish(lay_out_disk(disk, Eigen::VectorXd::Zero(topology.vertex_count), false), pole);
    map.is_uniform = false;
    return map;
}

}  // namespace kinequad
