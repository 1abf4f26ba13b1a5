#include "kinequad/symmetry/even_out_half.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kinequad/core/index.h"
#include "kinequad/core/parallel.h"
#include "kinequad/mesh/trace_geodesic.h"
#include "kinequad/solve/sparse_cholesky.h"
#include "kinequad/symmetry/unfold_patch.h"

namespace kinequad {
namespace {

constexpr int image_patch_limit = 200;
constexpr double least_weight = 0.05;
/// A round that lowers the energy by less than this share is the last.
constexpr double least_gain = 0.01;

/// What a vertex sees of a neighbour's image, in the frame of the triangle of its own image.
struct Sight {
    Complex edge;           ///< from its own image to the neighbour's
    Complex frame = 1;      ///< turns vectors in the neighbour's frame into its own
    bool is_known = false;  ///< false where the images are too far apart
};

class EvenMap {
public:
    EvenMap(const SymmetricHalf& half, const IntrinsicMetric& half_metric, const Topology& topology,
            const IntrinsicMetric& metric)
        : half_(half.mesh.F),
          half_topology_(build_topology(half.mesh.F, half.mesh.vertex_count)),
          topology_(topology),
          metric_(metric),
          image_(half.mirrored) {
        const int vertices = half.mesh.vertex_count;
        unknown_.assign(at(vertices), -1);
        for (int v = 0; v < vertices; ++v) {
            if (half.is_on_curve[at(v)] || half_topology_.is_boundary_vertex(v)) continue;
            if (half_topology_.vertex_half_edge[at(v)] >= 0) unknown_[at(v)] = unknown_count_++;
        }
        for (int t = 0; t < half_topology_.triangle_count; ++t) {
            const auto sides = side_lengths(half_topology_, half_metric, t);
            const auto layout = lay_out_triangle(sides);
            const std::array<double, 3> cotangents = opposite_cotangents(sides);
            std::array<Complex, 3> corner;
            // The map reverses orientation: triangles are compared with their mirror images.
            for (int k = 0; k < 3; ++k) corner[at(k)] = {layout(0, k), -layout(1, k)};
            Triangle triangle;
            for (std::size_t k = 0; k < 3; ++k) {
                triangle.side[k] = corner[(k + 1) % 3] - corner[k];
                triangle.weight[k] = std::clamp(cotangents[k], least_weight, 20.0);
            }
            triangle_.push_back(triangle);
        }
    }

    void look(const Context& context) {
        sight_.assign(half_topology_.origin.size(), Sight{});
        back_.assign(half_topology_.origin.size(), Sight{});
        parallel_for(unknown_.size(), 128, context, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) look_from(static_cast<int>(v));
        });
        energy_ = 0;
        rotation_.assign(triangle_.size(), 0);
        for (std::size_t t = 0; t < triangle_.size(); ++t) {
            const std::array<Complex, 3> sides = image_sides(static_cast<int>(t));
            Complex sum = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                sum += triangle_[t].weight[k] * sides[k] * std::conj(triangle_[t].side[k]);
            }
            rotation_[t] = std::abs(sum) > 0 ? sum / std::abs(sum) : Complex(1);
            for (std::size_t k = 0; k < 3; ++k) {
                energy_ += triangle_[t].weight[k] *
                           std::norm(sides[k] - rotation_[t] * triangle_[t].side[k]);
            }
        }
    }

    double energy() const { return energy_; }
    const std::vector<SurfacePoint>& image() const { return image_; }

    /// One solve for the best moves, and the moves.
    void move(const Context& context) {
        std::vector<Eigen::Triplet<Complex>> entries;
        Eigen::VectorXcd right = Eigen::VectorXcd::Zero(unknown_count_);
        Eigen::VectorXd diagonal = Eigen::VectorXd::Constant(unknown_count_, 1e-9);
        for (int h = 0; h < static_cast<int>(half_topology_.origin.size()); ++h) {
            const int t = h / 3;
            const int a = half_topology_.origin[at(h)];
            const int b = half_topology_.target(h);
            // Seen from a corner that moves: what both see is the same but for rounding.
            const bool from_a = unknown_[at(a)] >= 0;
            if (!from_a && unknown_[at(b)] < 0) continue;
            const int i = from_a ? a : b;
            const int j = from_a ? b : a;
            const Sight& sight = from_a ? sight_[at(h)] : back_[at(h)];
            if (!sight.is_known) continue;
            const double weight = triangle_[at(t)].weight[at(h % 3)];
            // The triangle's rotation lives in the frame of its first corner's image.
            const Complex turned = rotation_[at(t)] * frame_from_first(t, i);
            const Complex wanted =
                turned * triangle_[at(t)].side[at(h % 3)] * (from_a ? 1.0 : -1.0);
            const Complex residual = sight.edge - wanted;
            const int row = unknown_[at(i)];
            const int column = unknown_[at(j)];
            diagonal[row] += weight;
            right[row] += weight * residual;
            if (column < 0) continue;
            diagonal[column] += weight;
            right[column] -= weight * std::conj(sight.frame) * residual;
            if (row > column) {
                entries.emplace_back(row, column, -weight * sight.frame);
            } else {
                entries.emplace_back(column, row, -weight * std::conj(sight.frame));
            }
        }
        for (int i = 0; i < unknown_count_; ++i) entries.emplace_back(i, i, diagonal[i]);
        SparseCholesky<Complex>::Matrix A(unknown_count_, unknown_count_);
        A.setFromTriplets(entries.begin(), entries.end());
        const Eigen::VectorXcd d = SparseCholesky<Complex>(A).solve(right);
        parallel_for(image_.size(), 256, context, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) {
                if (unknown_[v] < 0) continue;
                const Complex step = d[unknown_[v]];
                if (!std::isfinite(std::abs(step))) continue;
                image_[v] =
                    trace_geodesic(topology_, metric_, image_[v], {step.real(), step.imag()});
            }
        });
    }

private:
    struct Triangle {
        std::array<Complex, 3> side;     ///< mirrored, in the triangle's frame
        std::array<double, 3> weight{};  ///< cotangents
    };

    /// Fills in what `v` sees along its half-edges, and against the half-edges that end in it.
    void look_from(int v) {
        if (half_topology_.vertex_half_edge[at(v)] < 0) return;
        const std::vector<int> fan = outgoing_half_edges(half_topology_, v);
        std::vector<int> around;
        around.reserve(fan.size() + 1);
        for (const int h : fan) around.push_back(half_topology_.target(h));
        const int last = Topology::previous(fan.back());
        around.push_back(half_topology_.origin[at(last)]);
        std::vector<SurfacePoint> wanted = {image_[at(v)]};
        for (const int w : around) {
            wanted.push_back(image_[at(w)]);
            wanted.push_back({image_[at(w)].triangle, Vector3::Constant(1.0 / 3)});
        }
        const UnfoldedPatch patch =
            unfold_patch(topology_, metric_, image_[at(v)].triangle, wanted, image_patch_limit);
        const auto sight_of = [&](std::size_t i) {
            Sight sight;
            if (!patch.is_found[1 + 2 * i] || !patch.is_found[2 + 2 * i]) return sight;
            const Vector2 edge = patch.position[1 + 2 * i] - patch.position[0];
            const auto place = std::find(patch.triangle.begin(), patch.triangle.end(),
                                         image_[at(around[i])].triangle);
            if (place == patch.triangle.end()) return sight;
            const auto& corners = patch.corners[at(std::distance(patch.triangle.begin(), place))];
            const Vector2 axis = corners.col(1) - corners.col(0);
            const double length = axis.norm();
            if (!(length > 0)) return sight;
            return Sight{{edge[0], edge[1]}, Complex(axis[0], axis[1]) / length, true};
        };
        for (std::size_t i = 0; i < fan.size(); ++i) {
            sight_[at(fan[i])] = sight_of(i);
            // The half-edge that comes in beside: from the next neighbour around to v.
            back_[at(Topology::previous(fan[i]))] = sight_of(i + 1);
        }
    }

    /// Sides of the image of triangle `t` in the frame of the image of its first corner.
    std::array<Complex, 3> image_sides(int t) const {
        const Sight& first = sight_[at(3 * t)];
        const Sight& last = back_[at(3 * t + 2)];
        if (!first.is_known || !last.is_known) return triangle_[at(t)].side;
        return {first.edge, last.edge - first.edge, -last.edge};
    }

    /// Turns vectors in the frame of the first corner of `t` into that of its corner `v`.
    Complex frame_from_first(int t, int v) const {
        if (half_(t, 0) == v) return 1;
        const Sight& sight = half_(t, 1) == v ? sight_[at(3 * t)] : back_[at(3 * t + 2)];
        return sight.is_known ? std::conj(sight.frame) : Complex(1);
    }

    const Triangles& half_;
    Topology half_topology_;
    const Topology& topology_;
    const IntrinsicMetric& metric_;
    std::vector<SurfacePoint> image_;
    std::vector<Triangle> triangle_;
    std::vector<int> unknown_;
    int unknown_count_ = 0;
    std::vector<Sight> sight_;  ///< half-edge: its end seen from its origin
    std::vector<Sight> back_;   ///< half-edge: its origin seen from its end
    std::vector<Complex> rotation_;
    double energy_ = 0;
};

}  // namespace

std::vector<SurfacePoint> even_out_half(const SymmetricHalf& half,
                                        const IntrinsicMetric& half_metric,
                                        const Topology& topology, const IntrinsicMetric& metric,
                                        int rounds, const Context& context) {
    EvenMap map(half, half_metric, topology, metric);
    map.look(context);
    std::vector<SurfacePoint> best = map.image();
    double least = map.energy();
    const double before = least;
    for (int round = 0; round < rounds; ++round) {
        map.move(context);
        map.look(context);
        if (!(map.energy() < least)) break;
        const bool is_last = map.energy() > (1 - least_gain) * least;
        least = map.energy();
        best = map.image();
        if (is_last) break;
    }
    context.write_log(LogLevel::info,
                      fmt::format("symmetry: the map of the half stretches less, {:.3g} instead of "
                                  "{:.3g}",
                                  least, before));
    return best;
}

}  // namespace kinequad
