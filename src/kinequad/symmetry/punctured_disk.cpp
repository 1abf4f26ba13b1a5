#include "kinequad/symmetry/punctured_disk.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/solve/sparse_cholesky.h"

namespace kinequad {
namespace {

constexpr double pi = std::numbers::pi;

/// Half-edges that leave a vertex of a closed triangulation, counter-clockwise; cut off at 64.
std::vector<int> star_of(const FlipTriangulation& mesh, int start) {
    std::vector<int> star;
    int h = start;
    do {
        star.push_back(h);
        h = mesh.twin[at(mesh.previous(h))];
    } while (h != start && star.size() < 64);
    return star;
}

std::array<double, 3> plain_sides(const FlipTriangulation& mesh, int t) {
    std::array<double, 3> sides{};
    for (int k = 0; k < 3; ++k) sides[at(k)] = mesh.length[at(mesh.edge[at(3 * t + k)])];
    return sides;
}

bool breaks_triangle_inequality(const std::array<double, 3>& s) {
    return s[0] >= s[1] + s[2] || s[1] >= s[2] + s[0] || s[2] >= s[0] + s[1];
}

/// Inner vertices numbered from 0; -1 for the link, the puncture and isolated ones.
std::vector<int> number_inner_vertices(const PuncturedDisk& disk, int& count) {
    std::vector<int> number(at(disk.vertex_count), -1);
    for (const int v : disk.mesh.origin) number[at(v)] = 0;
    for (const int v : disk.link) number[at(v)] = -1;
    count = 0;
    for (int& n : number) {
        if (n == 0) n = count++;
    }
    return number;
}

Eigen::VectorXd scale_of(const Eigen::VectorXd& u) { return (0.5 * u.array()).exp(); }

/// 2 pi minus the angle sum of inner vertices.
Eigen::VectorXd residual_of(const PuncturedDisk& disk, const Eigen::VectorXd& scale,
                            const std::vector<int>& number, int count) {
    Eigen::VectorXd residual = Eigen::VectorXd::Constant(count, 2 * pi);
    for (int t = 0; t < static_cast<int>(disk.mesh.origin.size() / 3); ++t) {
        const std::array<double, 3> angles = corner_angles(scaled_sides(disk.mesh, scale, t));
        for (int k = 0; k < 3; ++k) {
            const int i = number[at(disk.mesh.origin[at(3 * t + k)])];
            if (i >= 0) residual[i] -= angles[at(k)];
        }
    }
    return residual;
}

using Triplets = std::vector<Eigen::Triplet<double>>;

Eigen::SparseMatrix<double> hessian_of(const PuncturedDisk& disk, const Eigen::VectorXd& scale,
                                       const std::vector<int>& number, int count) {
    Triplets triplets;
    triplets.reserve(5 * disk.mesh.origin.size());
    // Keeps rows regular that only degenerate triangles touch.
    for (int i = 0; i < count; ++i) triplets.emplace_back(i, i, 1e-10);
    for (int t = 0; t < static_cast<int>(disk.mesh.origin.size() / 3); ++t) {
        const std::array<double, 3> sides = scaled_sides(disk.mesh, scale, t);
        if (breaks_triangle_inequality(sides)) continue;
        const std::array<double, 3> weights = opposite_cotangents(sides);
        for (int k = 0; k < 3; ++k) {
            const int h = 3 * t + k;
            const int i = number[at(disk.mesh.origin[at(h)])];
            const int j = number[at(disk.mesh.target(h))];
            const double w = weights[at(k)] / 2;
            if (i >= 0) triplets.emplace_back(i, i, w);
            if (j >= 0) triplets.emplace_back(j, j, w);
            if (i >= 0 && j >= 0) triplets.emplace_back(std::max(i, j), std::min(i, j), -w);
        }
    }
    Eigen::SparseMatrix<double> H(count, count);
    H.setFromTriplets(triplets.begin(), triplets.end());
    return H;
}

}  // namespace

bool has_good_star(const FlipTriangulation& mesh, int half_edge) {
    const std::vector<int> star = star_of(mesh, half_edge);
    if (star.size() < 4 || star.size() > 10) return false;
    std::vector<int> link;
    std::vector<int> triangles;
    for (const int h : star) {
        for (const double angle : corner_angles(plain_sides(mesh, h / 3))) {
            if (angle < 20 * pi / 180 || angle > 110 * pi / 180) return false;
        }
        link.push_back(mesh.target(h));
        triangles.push_back(h / 3);
    }
    const auto repeats = [](std::vector<int>& values) {
        std::sort(values.begin(), values.end());
        return std::adjacent_find(values.begin(), values.end()) != values.end();
    };
    return !repeats(link) && !repeats(triangles) &&
           std::find(link.begin(), link.end(), mesh.origin[at(half_edge)]) == link.end();
}

PuncturedDisk puncture_surface(const FlipTriangulation& mesh, int half_edge, int vertex_count) {
    PuncturedDisk disk;
    disk.vertex_count = vertex_count;
    disk.puncture = mesh.origin[at(half_edge)];
    const std::vector<int> star = star_of(mesh, half_edge);
    std::vector<bool> is_removed(mesh.origin.size() / 3, false);
    double turned = 0;
    for (const int h : star) {
        is_removed[at(h / 3)] = true;
        disk.link.push_back(mesh.target(h));
        disk.spoke.push_back(mesh.length[at(mesh.edge[at(h)])]);
        disk.bearing.push_back(turned);
        turned += corner_angles(plain_sides(mesh, h / 3))[at(h % 3)];
    }
    for (double& angle : disk.bearing) angle *= 2 * pi / turned;
    // Around the puncture the link runs counter-clockwise, with the disk on its right.
    std::reverse(disk.link.begin(), disk.link.end());
    std::reverse(disk.spoke.begin(), disk.spoke.end());
    std::reverse(disk.bearing.begin(), disk.bearing.end());
    std::vector<int> slot(mesh.origin.size(), -1);
    int kept = 0;
    for (std::size_t h = 0; h < slot.size(); ++h) {
        if (!is_removed[h / 3]) slot[h] = kept++;
    }
    disk.mesh.length = mesh.length;
    disk.mesh.half_edge.assign(mesh.half_edge.size(), -1);
    for (std::size_t h = 0; h < slot.size(); ++h) {
        if (slot[h] < 0) continue;
        const int other = mesh.twin[h];
        disk.mesh.origin.push_back(mesh.origin[h]);
        disk.mesh.twin.push_back(other < 0 ? -1 : slot[at(other)]);
        disk.mesh.edge.push_back(mesh.edge[h]);
        disk.mesh.half_edge[at(mesh.edge[h])] = slot[h];
    }
    return disk;
}

Eigen::VectorXd flatten_disk(PuncturedDisk& disk, const Context& context) {
    int count = 0;
    const std::vector<int> number = number_inner_vertices(disk, count);
    Eigen::VectorXd u = Eigen::VectorXd::Zero(disk.vertex_count);
    double mean = 0;
    for (const double length : disk.spoke) {
        mean += 2 * std::log(length) / static_cast<double>(disk.spoke.size());
    }
    for (std::size_t i = 0; i < disk.link.size(); ++i) {
        u[disk.link[i]] = mean - 2 * std::log(disk.spoke[i]);
    }
    const auto moved = [&](const Eigen::VectorXd& step, double amount) {
        Eigen::VectorXd result = u;
        for (int v = 0; v < disk.vertex_count; ++v) {
            if (number[at(v)] >= 0) result[v] += amount * step[number[at(v)]];
        }
        return result;
    };
    Eigen::VectorXd scale = scale_of(u);
    flip_to_delaunay(disk.mesh, scale, FlipRule::ptolemy);
    Eigen::VectorXd residual = residual_of(disk, scale, number, count);
    for (int round = 0; round < 60; ++round) {
        context.check_cancelled();
        if (count == 0 || residual.cwiseAbs().maxCoeff() < 1e-9) return u;
        const SparseCholesky<double> factor(hessian_of(disk, scale, number, count));
        const Eigen::VectorXd step = factor.solve(-residual);
        bool is_accepted = false;
        for (double amount = 1; amount > 1e-4 && !is_accepted; amount /= 2) {
            const Eigen::VectorXd trial = moved(step, amount);
            if (!trial.allFinite() || trial.cwiseAbs().maxCoeff() > 600) continue;
            scale = scale_of(trial);
            // Ptolemy flips change the triangulation, not the structure: a rejected trial needs no
            // undoing.
            flip_to_delaunay(disk.mesh, scale, FlipRule::ptolemy);
            const Eigen::VectorXd there = residual_of(disk, scale, number, count);
            if (there.dot(step) <= 0 || there.norm() < residual.norm()) {
                u = trial;
                residual = there;
                is_accepted = true;
            }
        }
        if (!is_accepted) break;
    }
    if (residual.cwiseAbs().maxCoeff() < 1e-6) return u;
    throw Error(ExitCode::internal_failure, "the surface could not be flattened");
}

Eigen::Matrix<Real, Eigen::Dynamic, 2> lay_out_disk(const PuncturedDisk& disk,
                                                    const Eigen::VectorXd& u, bool is_flat) {
    using Plane = Eigen::Matrix<Real, Eigen::Dynamic, 2>;
    int count = 0;
    const std::vector<int> number = number_inner_vertices(disk, count);
    const Eigen::VectorXd scale = scale_of(u);
    Plane z = Plane::Zero(disk.vertex_count, 2);
    if (is_flat) {
        std::vector<double> angle_sum(at(disk.vertex_count), 0.0);
        std::vector<int> border(at(disk.vertex_count), -1);
        for (int t = 0; t < static_cast<int>(disk.mesh.origin.size() / 3); ++t) {
            const std::array<double, 3> angles = corner_angles(scaled_sides(disk.mesh, scale, t));
            for (int k = 0; k < 3; ++k) {
                const int h = 3 * t + k;
                angle_sum[at(disk.mesh.origin[at(h)])] += angles[at(k)];
                if (disk.mesh.twin[at(h)] < 0) border[at(disk.mesh.origin[at(h)])] = h;
            }
        }
        Real x = 0;
        Real y = 0;
        double direction = 0;
        for (const int v : disk.link) {
            z.row(v) << x, y;
            const int h = border[at(v)];
            const double length =
                scale[v] * scale[disk.mesh.target(h)] * disk.mesh.length[at(disk.mesh.edge[at(h)])];
            // The direction of this side was turned to when the previous vertex was passed.
            x += length * std::cos(direction);
            y += length * std::sin(direction);
            direction += pi - angle_sum[at(disk.mesh.target(h))];
        }
    } else {
        for (std::size_t i = 0; i < disk.link.size(); ++i) {
            z.row(disk.link[i]) << std::cos(disk.bearing[i]) / disk.spoke[i],
                -std::sin(disk.bearing[i]) / disk.spoke[i];
        }
    }
    if (count == 0) return z;
    // Unlike unfolding, the harmonic solve does not add up the rounding of long thin limbs.
    std::vector<Eigen::Triplet<double>> triplets;
    struct Coupling {
        int i, j;  // vertices
        double weight;
    };
    std::vector<Coupling> couplings;
    std::vector<double> weight(disk.mesh.half_edge.size(), 0.0);
    for (int t = 0; t < static_cast<int>(disk.mesh.origin.size() / 3); ++t) {
        const std::array<double, 3> cotangents =
            opposite_cotangents(scaled_sides(disk.mesh, scale, t));
        for (int k = 0; k < 3; ++k) {
            weight[at(disk.mesh.edge[at(3 * t + k)])] += cotangents[at(k)] / 2;
        }
    }
    for (std::size_t e = 0; e < weight.size(); ++e) {
        const int h = disk.mesh.half_edge[e];
        if (h < 0) continue;
        const int a = disk.mesh.origin[at(h)];
        const int b = disk.mesh.target(h);
        if (a == b) continue;
        const double w = std::max(weight[e], 1e-9);
        const int i = number[at(a)];
        const int j = number[at(b)];
        if (i >= 0) triplets.emplace_back(i, i, w);
        if (j >= 0) triplets.emplace_back(j, j, w);
        if (i >= 0 && j >= 0) triplets.emplace_back(std::max(i, j), std::min(i, j), -w);
        couplings.push_back({a, b, w});
    }
    Eigen::SparseMatrix<double> L(count, count);
    L.setFromTriplets(triplets.begin(), triplets.end());
    const SparseCholesky<double> factor(L);
    // Iterative refinement with long residuals gives the inner shape of tiny limbs.
    for (int round = 0; round < 4; ++round) {
        Plane residual = Plane::Zero(count, 2);
        for (const Coupling& c : couplings) {
            const Eigen::Matrix<Real, 1, 2> force = Real(c.weight) * (z.row(c.j) - z.row(c.i));
            if (number[at(c.i)] >= 0) residual.row(number[at(c.i)]) += force;
            if (number[at(c.j)] >= 0) residual.row(number[at(c.j)]) -= force;
        }
        for (int axis = 0; axis < 2; ++axis) {
            const Eigen::VectorXd right = residual.col(axis).cast<double>();
            const Eigen::VectorXd step = factor.solve(right);
            for (int v = 0; v < disk.vertex_count; ++v) {
                if (number[at(v)] >= 0) z(v, axis) += step[number[at(v)]];
            }
        }
    }
    return z;
}

}  // namespace kinequad
