#include "kinequad/gridmap/map_system.h"

#include <algorithm>
#include <cmath>

#include "kinequad/core/index.h"

namespace kinequad {
namespace {

/// Area, as a share of the longest side squared, below which a triangle counts as a sliver.
constexpr double least_area_share = 1e-5;

TargetShape shape_of(std::array<Complex, 3> q) {
    const auto twice_area = [&] { return std::imag(std::conj(q[1] - q[0]) * (q[2] - q[0])); };
    std::size_t apex = 0;
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double side = std::abs(q[(k + 2) % 3] - q[(k + 1) % 3]);
        if (side > longest) {
            longest = side;
            apex = k;
        }
    }
    // A sliver is fattened: its gradients would swamp all others.
    const double least = 2 * least_area_share * longest * longest;
    if (twice_area() < least && longest > 0) {
        const Complex base = q[(apex + 2) % 3] - q[(apex + 1) % 3];
        q[apex] += Complex(0, 1) * base / longest * ((least - twice_area()) / longest);
    }
    TargetShape shape;
    shape.area = std::max(twice_area(), 1e-300) / 2;
    for (std::size_t k = 0; k < 3; ++k) {
        const Complex gradient =
            Complex(0, 1) * (q[(k + 2) % 3] - q[(k + 1) % 3]) / (2 * shape.area);
        shape.gradient[k] = std::conj(gradient) / 2.0;
    }
    return shape;
}

}  // namespace

Vector6 TargetShape::functional(Complex direction, bool anti) const {
    Vector6 result;
    for (std::size_t k = 0; k < 3; ++k) {
        const Complex g = (anti ? std::conj(gradient[k]) : gradient[k]) * std::conj(direction);
        result[static_cast<Eigen::Index>(2 * k)] = g.real();
        result[static_cast<Eigen::Index>(2 * k + 1)] = -g.imag();
    }
    return result;
}

std::vector<TargetShape> target_shapes(const ChartedMesh& mesh, double scale) {
    std::vector<TargetShape> shapes;
    shapes.reserve(mesh.parent.size());
    for (std::size_t t = 0; t < mesh.parent.size(); ++t) {
        shapes.push_back(shape_of({scale * mesh.target[3 * t], scale * mesh.target[3 * t + 1],
                                   scale * mesh.target[3 * t + 2]}));
    }
    return shapes;
}

TriangleSystem::TriangleSystem(const MapVariables& variables) : variables_(variables) {
    const auto triangles = static_cast<int>((variables.row_start.size() - 1) / 6);
    const auto for_each_term = [&](int t, const auto& visit) {
        for (int i = 0; i < 6; ++i) {
            for (int j = 0; j < 6; ++j) {
                for (int a = variables.row_start[at(6 * t + i)];
                     a < variables.row_start[at(6 * t + i + 1)]; ++a) {
                    for (int b = variables.row_start[at(6 * t + j)];
                         b < variables.row_start[at(6 * t + j + 1)]; ++b) {
                        const int row = variables.column[at(a)];
                        const int column = variables.column[at(b)];
                        if (row < column) continue;
                        visit(row, column, 6 * i + j,
                              variables.coefficient[at(a)] * variables.coefficient[at(b)]);
                    }
                }
            }
        }
    };
    std::vector<Eigen::Triplet<double>> pattern;
    pattern.reserve(at(variables.columns()) + 25 * at(triangles));
    for (int c = 0; c < variables.columns(); ++c) pattern.emplace_back(c, c, 0.0);
    for (int t = 0; t < triangles; ++t) {
        for_each_term(
            t, [&](int row, int column, int, double) { pattern.emplace_back(row, column, 0.0); });
    }
    const auto for_each_whole_term = [&](const auto& visit) {
        for (int w = 0; w < variables.position_count; ++w) {
            for (const auto& [a, ca] : variables.whole[at(w)]) {
                for (const auto& [b, cb] : variables.whole[at(w)]) {
                    if (a >= b)
                        visit(variables.vertex_columns + a, variables.vertex_columns + b, ca * cb);
                }
            }
        }
    };
    for_each_whole_term(
        [&](int row, int column, double) { pattern.emplace_back(row, column, 0.0); });
    matrix_.resize(variables.columns(), variables.columns());
    matrix_.setFromTriplets(pattern.begin(), pattern.end());
    matrix_.makeCompressed();

    const auto slot_of = [&](int row, int column) {
        const int* begin = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[column];
        const int* end = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[column + 1];
        return static_cast<int>(std::lower_bound(begin, end, row) - matrix_.innerIndexPtr());
    };
    term_start_.push_back(0);
    for (int t = 0; t < triangles; ++t) {
        for_each_term(t, [&](int row, int column, int local, double coefficient) {
            terms_.push_back({slot_of(row, column), local, coefficient});
        });
        term_start_.push_back(static_cast<int>(terms_.size()));
    }
    for_each_whole_term([&](int row, int column, double coefficient) {
        whole_terms_.push_back({slot_of(row, column), 0, coefficient});
    });
}

const Eigen::SparseMatrix<double>& TriangleSystem::assemble(
    const std::function<Matrix6(int t)>& matrix_of, double whole_weight) {
    double* values = matrix_.valuePtr();
    std::fill(values, values + matrix_.nonZeros(), 0.0);
    for (int t = 0; t + 1 < static_cast<int>(term_start_.size()); ++t) {
        const Matrix6 local = matrix_of(t);
        for (int i = term_start_[at(t)]; i < term_start_[at(t + 1)]; ++i) {
            const Term& term = terms_[at(i)];
            values[term.slot] += term.coefficient * local.data()[term.local];
        }
    }
    for (const Term& term : whole_terms_) values[term.slot] += whole_weight * term.coefficient;
    return matrix_;
}

Eigen::VectorXd TriangleSystem::gather(const std::function<Vector6(int t)>& vector_of) const {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(variables_.columns());
    for (int t = 0; t + 1 < static_cast<int>(term_start_.size()); ++t) {
        const Vector6 local = vector_of(t);
        for (int i = 0; i < 6; ++i) {
            for (int a = variables_.row_start[at(6 * t + i)];
                 a < variables_.row_start[at(6 * t + i + 1)]; ++a) {
                sum[variables_.column[at(a)]] += variables_.coefficient[at(a)] * local[i];
            }
        }
    }
    return sum;
}

}  // namespace kinequad
