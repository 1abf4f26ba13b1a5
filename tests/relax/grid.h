#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <utility>
#include <vector>

#include "kinequad/extract/verify_quad_mesh.h"
#include "kinequad/mesh/closest_points.h"
#include "kinequad/relax/sliding_quads.h"
#include "support/shapes.h"

namespace kinequad::test {

/// The unit square, lifted to `z = height(x, y)`.
inline TriangleMesh landscape(int n, const std::function<double(double, double)>& height) {
    TriangleMesh mesh = square(n);
    for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
        mesh.V(v, 2) = height(mesh.V(v, 0), mesh.V(v, 1));
    }
    return mesh;
}

inline double flat(double, double) { return 0; }
inline double hill(double x, double y) { return 0.4 * x * (1 - x) * y * (2 - y); }

/// `k` x `k` quads over the unit square, inner vertices moved by up to `jitter` of a quad.
struct Grid {
    TriangleMesh mesh;
    Topology topology;
    IntrinsicMetric metric;
    QuadMesh quads;

    Grid(TriangleMesh shape, int k, double jitter, unsigned seed = 1)
        : mesh(std::move(shape)),
          topology(build_topology(mesh.F, static_cast<int>(mesh.V.rows()))),
          metric(metric_of(topology, mesh.V)) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> away(-jitter / k, jitter / k);
        for (int i = 0; i <= k; ++i) {
            for (int j = 0; j <= k; ++j) {
                const bool is_inner = i > 0 && i < k && j > 0 && j < k;
                const double x = double(j) / k + (is_inner ? away(random) : 0);
                const double y = double(i) / k + (is_inner ? away(random) : 0);
                quads.vertex.push_back(above(x, y));
            }
        }
        quads.Q.resize(k * k, 4);
        for (int i = 0; i < k; ++i) {
            for (int j = 0; j < k; ++j) {
                const int v = i * (k + 1) + j;
                quads.Q.row(i * k + j) << v, v + 1, v + k + 2, v + k + 1;
            }
        }
    }

    /// The point of the surface over (x, y).
    SurfacePoint above(double x, double y) const {
        Positions plan = mesh.V;
        plan.col(2).setZero();
        SurfacePoint point = ClosestPoints(plan, mesh.F).find(Vector3(x, y, 0)).point;
        point.barycentric = point.barycentric.cwiseMax(0);
        point.barycentric /= point.barycentric.sum();
        return point;
    }

    QuadCorners corners(const QuadMesh& of, const Positions& frame, Eigen::Index q) const {
        QuadCorners p;
        for (int k = 0; k < 4; ++k) {
            p[static_cast<std::size_t>(k)] =
                position_of(of.vertex[static_cast<std::size_t>(of.Q(q, k))], frame, mesh.F);
        }
        return p;
    }

    double cost(const QuadMesh& of, const Positions& frame) const {
        double sum = 0;
        for (Eigen::Index q = 0; q < of.Q.rows(); ++q) {
            sum += quad_cost(corners(of, frame, q), FoldBarrier{});
        }
        return sum;
    }

    /// Sum over the sides of all quads of their squared lengths, in mean lengths before.
    double side_squares(const QuadMesh& of, const Positions& frame) const {
        double sum = 0;
        double lengths = 0;
        for (Eigen::Index q = 0; q < of.Q.rows(); ++q) {
            const QuadCorners now = corners(of, frame, q);
            const QuadCorners before = corners(quads, frame, q);
            for (std::size_t k = 0; k < 4; ++k) {
                sum += (now[(k + 1) % 4] - now[k]).squaredNorm();
                lengths += (before[(k + 1) % 4] - before[k]).norm();
            }
        }
        const double mean = lengths / static_cast<double>(of.Q.size());
        return sum / (mean * mean);
    }

    /// What passes lower: edges inside have two quads.
    double relaxing_cost(const QuadMesh& of, const Positions& frame) const {
        return cost(of, frame) + spacing_weight / 2 * side_squares(of, frame);
    }

    double least_jacobian(const QuadMesh& of, const Positions& frame) const {
        double least = 1;
        for (Eigen::Index q = 0; q < of.Q.rows(); ++q) {
            least = std::min(least, least_scaled_jacobian(corners(of, frame, q)));
        }
        return least;
    }

    /// Largest distance between the quads and the mesh as it is.
    double farthest() const {
        const std::vector<double> distances = sliding({{mesh.V, 1}}).distances({});
        return *std::max_element(distances.begin(), distances.end());
    }

    ClosestPoints surface() const { return {mesh.V, mesh.F}; }

    SlidingQuads sliding(std::vector<SampledFrame> frames) const {
        return SlidingQuads(quads, topology, metric, mesh.F, std::move(frames), 1);
    }

    /// Connectivity and boundary are as before, and all vertices on the surface.
    void expect_kept(const QuadMesh& after) const {
        EXPECT_EQ(after.Q, quads.Q);
        EXPECT_TRUE(verify_quad_mesh(after, topology).valid());
        const int side = static_cast<int>(std::lround(std::sqrt(double(quads.vertex.size()))));
        for (int v = 0; v < static_cast<int>(quads.vertex.size()); ++v) {
            const int i = v / side;
            const int j = v % side;
            if (i > 0 && j > 0 && i + 1 < side && j + 1 < side) continue;
            const auto index = static_cast<std::size_t>(v);
            EXPECT_EQ(after.vertex[index].triangle, quads.vertex[index].triangle);
            EXPECT_EQ(after.vertex[index].barycentric, quads.vertex[index].barycentric);
        }
    }
};

inline Positions sheared(const Positions& V, double by) {
    Positions result = V;
    result.col(0) += by * V.col(1);
    return result;
}

/// A spike on the vertex nearest to (0.55, 0.47), which no vertex of a 6 x 6 grid is near.
inline Grid spiked(int* tip) {
    TriangleMesh mesh = landscape(20, flat);
    (mesh.V.rowwise() - Eigen::RowVector3d(0.55, 0.45, 0)).rowwise().squaredNorm().minCoeff(tip);
    mesh.V(*tip, 2) = 0.12;
    return Grid(std::move(mesh), 6, 0);
}

}  // namespace kinequad::test
