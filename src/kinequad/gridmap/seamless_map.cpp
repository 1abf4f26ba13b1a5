#include "kinequad/gridmap/seamless_map.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <cmath>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/solve/minimum_degree_order.h"

namespace kinequad {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;
using Permutation = Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int>;

/// What the projection asks of a triangle `f(q) = a q + b conj(q)`:
/// `|b| <= steepness * (Re a - margin)`.
constexpr double steepness = 0.8;
constexpr double margin = 0.1;
constexpr double over_relaxation = 1.6;
constexpr int most_weighted_rounds = 100;
constexpr int most_plain_rounds = 200;
/// How often triangles that stay reversed get more weight, by how much, and the rounds each time.
constexpr int most_reweightings = 5;
constexpr double reweighting = 20;
constexpr int most_reweighted_rounds = 100;

/// What the imaginary parts of a and b count in a least-squares solve, against their real parts.
struct PartWeights {
    double turn = 1;   ///< Im a
    double shear = 1;  ///< Im b
};
constexpr PartWeights weighted{turn_weight, shear_weight};
constexpr PartWeights plain{};

Matrix6 quadratic_matrix(const TargetShape& shape, const PartWeights& weights) {
    Matrix6 sum = Matrix6::Zero();
    for (const bool anti : {false, true}) {
        for (const Complex direction : {Complex(1, 0), Complex(0, 1)}) {
            const Vector6 f = shape.functional(direction, anti);
            const double weight = direction.imag() == 0 ? 1 : anti ? weights.shear : weights.turn;
            sum += 4 * shape.area * weight * f * f.transpose();
        }
    }
    return sum;
}

/// Fill-reducing order of the vertex columns, followed by the chain columns, so that the trailing
/// block of the factor is that of the Schur complement of the chain columns.
Permutation chains_last(const SparseMatrix& lower, int vertex_columns) {
    const SparseMatrix block = lower.topLeftCorner(vertex_columns, vertex_columns);
    Permutation inverse;
    MinimumDegreeOrder()(block.selfadjointView<Eigen::Lower>(), inverse);
    const auto n = static_cast<int>(lower.rows());
    Permutation order(n);
    // AMD returns the permutation whose inverse puts the rows in elimination order.
    const Permutation direct = inverse.inverse();
    for (int i = 0; i < vertex_columns; ++i) order.indices()[i] = direct.indices()[i];
    for (int i = vertex_columns; i < n; ++i) order.indices()[i] = i;
    return order;
}

class LeastSquaresMap {
public:
    LeastSquaresMap(const MapVariables& variables, TriangleSystem& system,
                    const std::vector<TargetShape>& shapes, const PartWeights& weights)
        : variables_(variables), system_(system), shapes_(shapes), weights_(weights) {
        SparseMatrix lower =
            system.assemble([&](int t) { return quadratic_matrix(shapes[at(t)], weights); });
        order_ = chains_last(lower, variables.vertex_columns);
        SparseMatrix ordered(lower.rows(), lower.cols());
        ordered.selfadjointView<Eigen::Lower>() =
            lower.selfadjointView<Eigen::Lower>().twistedBy(order_);
        factor_.compute(ordered);
        if (factor_.info() != Eigen::Success) {
            throw GridMapError("the seamless map's system is singular");
        }
    }

    /// The map whose triangles come closest to `f(q) = a q + b conj(q)`, `parts` = (a, b) a
    /// triangle.
    Eigen::VectorXd solve(const std::vector<std::pair<Complex, Complex>>& parts) const {
        const Eigen::VectorXd right = system_.gather([&](int t) -> Vector6 {
            const TargetShape& shape = shapes_[at(t)];
            const auto& [a, b] = parts[at(t)];
            return 4 * shape.area *
                   (shape.functional({a.real(), weights_.turn * a.imag()}, false) +
                    shape.functional({b.real(), weights_.shear * b.imag()}, true));
        });
        return order_.transpose() * factor_.solve(order_ * right).eval();
    }

    /// Schur complement of the chain columns.
    Eigen::MatrixXd chain_block() const {
        const int first = variables_.vertex_columns;
        const int count = variables_.chain_columns;
        Eigen::MatrixXd lower = Eigen::MatrixXd::Identity(count, count);
        const SparseMatrix& factor = factor_.matrixL().nestedExpression();
        for (int c = 0; c < count; ++c) {
            for (SparseMatrix::InnerIterator entry(factor, first + c); entry; ++entry) {
                if (entry.row() > first + c) lower(entry.row() - first, c) = entry.value();
            }
        }
        return lower * factor_.vectorD().tail(count).asDiagonal() * lower.transpose();
    }

private:
    const MapVariables& variables_;
    TriangleSystem& system_;
    const std::vector<TargetShape>& shapes_;
    PartWeights weights_;
    Permutation order_;
    Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Eigen::NaturalOrdering<int>> factor_;
};

/// The nearest pair (a, b) within the cone of orientation-keeping maps, over-relaxed.
std::pair<Complex, Complex> projected(Complex a, Complex b) {
    const double x = a.real() - margin;
    const double y = std::abs(b);
    if (y <= steepness * x) return {a, b};
    const double s = std::max(0.0, (x + steepness * y) / (1 + steepness * steepness));
    const double new_x = x + over_relaxation * (s - x);
    const double new_y = y + over_relaxation * (steepness * s - y);
    return {Complex(new_x + margin, a.imag()), y > 0 ? b * (new_y / y) : b};
}

int count_reversed(const std::vector<TargetShape>& shapes, const std::vector<Complex>& corners) {
    int count = 0;
    for (std::size_t t = 0; t < shapes.size(); ++t) {
        count += keeps_direction(shapes[t], &corners[3 * t]) ? 0 : 1;
    }
    return count;
}

/// Alternates between the nearest maps of single triangles that keep their direction and the
/// nearest map of the whole surface, until no triangle of `map` is reversed.
void project(const LeastSquaresMap& least_squares, const MapVariables& variables,
             const std::vector<TargetShape>& shapes, int most_rounds, SeamlessMap& map,
             const Context& context) {
    std::vector<std::pair<Complex, Complex>> parts(shapes.size());
    for (int round = 0; round < most_rounds && map.reversed_triangles > 0; ++round) {
        context.check_cancelled();
        std::vector<Complex> corners = variables.corner_coordinates(map.x);
        for (std::size_t t = 0; t < shapes.size(); ++t) {
            parts[t] = projected(shapes[t].conformal_part(&corners[3 * t]),
                                 shapes[t].anticonformal_part(&corners[3 * t]));
        }
        map.x = least_squares.solve(parts);
        map.reversed_triangles = count_reversed(shapes, variables.corner_coordinates(map.x));
    }
}

}  // namespace

bool keeps_direction(const TargetShape& shape, const Complex* corners) {
    return std::abs(shape.anticonformal_part(corners)) < shape.conformal_part(corners).real();
}

SeamlessMap solve_seamless_map(const MapVariables& variables, TriangleSystem& system,
                               const std::vector<TargetShape>& shapes, const Context& context) {
    const LeastSquaresMap least_squares(variables, system, shapes, weighted);
    SeamlessMap map;
    map.x = least_squares.solve(
        std::vector<std::pair<Complex, Complex>>(shapes.size(), {Complex(1, 0), Complex(0, 0)}));

    const Eigen::PartialPivLU<Eigen::MatrixXd> lattice(variables.lattice);
    const auto integers_of = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
        if (variables.integer_count() == 0) return Eigen::VectorXd();
        return lattice.solve(x.tail(variables.chain_columns));
    };
    map.best_integers = integers_of(map.x);
    map.stiffness =
        0.5 * variables.lattice.transpose() * least_squares.chain_block() * variables.lattice;

    map.reversed_triangles = count_reversed(shapes, variables.corner_coordinates(map.x));
    project(least_squares, variables, shapes, most_weighted_rounds, map, context);
    if (map.reversed_triangles > 0) {
        // Projections meet for certain where both are taken in one norm, the plain one.
        const LeastSquaresMap plain_squares(variables, system, shapes, plain);
        project(plain_squares, variables, shapes, most_plain_rounds, map, context);
    }
    // Small triangles among large ones have little say; projections meet in any weights.
    std::vector<TargetShape> weighted_shapes = shapes;
    for (int i = 0; i < most_reweightings && map.reversed_triangles > 0; ++i) {
        const std::vector<Complex> corners = variables.corner_coordinates(map.x);
        for (std::size_t t = 0; t < shapes.size(); ++t) {
            if (!keeps_direction(shapes[t], &corners[3 * t]))
                weighted_shapes[t].area *= reweighting;
        }
        const LeastSquaresMap reweighted(variables, system, weighted_shapes, plain);
        project(reweighted, variables, weighted_shapes, most_reweighted_rounds, map, context);
        context.write_log(LogLevel::debug,
                          fmt::format("gridmap: {} triangles reversed after reweighting",
                                      map.reversed_triangles));
    }
    map.integers = integers_of(map.x);
    return map;
}

}  // namespace kinequad
