#include "kinequad/deformation/frame_curvature.h"

#include <Eigen/Geometry>
#include <cmath>

#include "kinequad/core/index.h"
#include "kinequad/core/parallel.h"

namespace kinequad {
namespace {

constexpr std::size_t curvature_block = 2048;
constexpr int averaging_rounds = 4;

Vector3 point(const Positions& V, int v) { return V.row(v).transpose(); }

/// Twice-area normals of all triangles.
std::vector<Vector3> triangle_normals(const Topology& topology, const Positions& V,
                                      const Context& context) {
    std::vector<Vector3> normals(at(topology.triangle_count));
    parallel_for(normals.size(), curvature_block, context, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const Vector3 p = point(V, topology.origin[3 * t]);
            normals[t] = (point(V, topology.origin[3 * t + 1]) - p)
                             .cross(point(V, topology.origin[3 * t + 2]) - p);
        }
    });
    return normals;
}

/// Signed dihedral angle times length of every edge; positive where the surface is convex.
std::vector<double> edge_bends(const Topology& topology, const Positions& V,
                               const std::vector<Vector3>& normals, const Context& context) {
    std::vector<double> bends(at(topology.edge_count), 0);
    parallel_for(bends.size(), curvature_block, context, [&](std::size_t begin, std::size_t end) {
        for (std::size_t e = begin; e < end; ++e) {
            const int h = topology.edge_half_edge[e];
            const int other = topology.twin[at(h)];
            if (other < 0) continue;
            const Vector3 along = point(V, topology.target(h)) - point(V, topology.origin[at(h)]);
            const Vector3& here = normals[at(h / 3)];
            const Vector3& there = normals[at(other / 3)];
            const double length = along.norm();
            const double sine = here.cross(there).dot(along);
            const double cosine = here.dot(there) * length;
            if (sine != 0 || cosine != 0) bends[e] = length * std::atan2(sine, cosine);
        }
    });
    return bends;
}

}  // namespace

FrameCurvature::FrameCurvature(const Topology& topology, const IntrinsicMetric& metric)
    : topology_(topology), across_(topology.twin.size()), arriving_(topology.twin.size(), 0) {
    for (int t = 0; t < topology.triangle_count; ++t) {
        const auto directions = half_edge_directions(side_lengths(topology, metric, t));
        for (std::size_t k = 0; k < 3; ++k) {
            across_[3 * at(t) + k] = -std::polar(1.0, 2 * directions[k]);
        }
    }
    for (std::size_t h = 0; h < across_.size(); ++h) {
        const int other = topology.twin[h];
        if (other >= 0) arriving_[h] = across_[h] * std::conj(across_[at(other)]);
    }
}

void FrameCurvature::accumulate(const Positions& V, double edge_length, const Context& context,
                                Eigen::VectorXcd& sum) const {
    struct Bend {
        Complex q;
        double area = 0;
    };
    const std::size_t count = at(topology_.triangle_count);
    const std::vector<Vector3> normals = triangle_normals(topology_, V, context);
    const std::vector<double> bends = edge_bends(topology_, V, normals, context);
    std::vector<Bend> bend(count);
    std::vector<Bend> averaged(count);
    parallel_for(count, curvature_block, context, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            bend[t].area = 0.5 * normals[t].norm();
            for (std::size_t h = 3 * t; h < 3 * t + 3; ++h) {
                bend[t].q += bends[at(topology_.edge[h])] * across_[h];
            }
        }
    });
    for (int round = 0; round < averaging_rounds; ++round) {
        parallel_for(count, curvature_block, context, [&](std::size_t begin, std::size_t end) {
            for (std::size_t t = begin; t < end; ++t) {
                double re = bend[t].q.real();
                double im = bend[t].q.imag();
                double area = bend[t].area;
                for (std::size_t h = 3 * t; h < 3 * t + 3; ++h) {
                    if (topology_.twin[h] < 0) continue;
                    const Bend& other = bend[at(topology_.twin[h] / 3)];
                    // Written out: the standard product of complex numbers checks for infinities.
                    re +=
                        arriving_[h].real() * other.q.real() - arriving_[h].imag() * other.q.imag();
                    im +=
                        arriving_[h].real() * other.q.imag() + arriving_[h].imag() * other.q.real();
                    area += other.area;
                }
                averaged[t] = {{re, im}, area};
            }
        });
        std::swap(bend, averaged);
    }
    parallel_for(count, curvature_block, context, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const double re = bend[t].q.real();
            const double im = bend[t].q.imag();
            const double square = re * re + im * im;
            if (!(square > 0) || !(bend[t].area > 0)) continue;
            const double bent = edge_length / (2 * bend[t].area);
            const double x = bent * bent * square;
            const double weight = x / ((1 + x) * square);
            sum[static_cast<Eigen::Index>(t)] +=
                Complex(weight * (re * re - im * im), weight * 2 * re * im);
        }
    });
}

}  // namespace kinequad
