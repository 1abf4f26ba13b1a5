#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <functional>
#include <vector>

#include "kinequad/gridmap/map_variables.h"

namespace kinequad {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// How much shearing the grid lines, and turning them away from the cross, count against stretching
/// quads in the energy `2 (Re a - 1)^2 + 2 turn_weight (Im a)^2 + 2 (Re b)^2 + 2 shear_weight (Im
/// b)^2` of a triangle: a stretched quad is still a rectangle along the cross.
inline constexpr double shear_weight = 8;
inline constexpr double turn_weight = 2;

/// The shape a triangle should have in the parameter plane, as what is needed to differentiate a
/// linear map of it: `f(q) = a q + b conj(q) + const`, `a = sum_k g_k z_k`, `b = sum_k conj(g_k)
/// z_k` over the corner images `z_k`. The map keeps orientation where |a| > |b|.
struct TargetShape {
    double area = 0;  ///< in cells; at least a tiny share of the longest side squared
    std::array<Complex, 3> gradient;  ///< g_k

    Complex conformal_part(const Complex* z) const {
        return gradient[0] * z[0] + gradient[1] * z[1] + gradient[2] * z[2];
    }
    Complex anticonformal_part(const Complex* z) const {
        return std::conj(gradient[0]) * z[0] + std::conj(gradient[1]) * z[1] +
               std::conj(gradient[2]) * z[2];
    }
    /// The 6-vector (u0, v0, u1, ...) whose product with the corner coordinates is Re(conj(d) a),
    /// or with `anti` Re(conj(d) b).
    Vector6 functional(Complex direction, bool anti) const;
};

/// Shapes of all triangles of a charted mesh, scaled by `scale`.
std::vector<TargetShape> target_shapes(const ChartedMesh& mesh, double scale);

/// Sums up 6-vectors and 6 x 6 matrices of triangles, given over the corner coordinates
/// (u0, v0, u1, v1, u2, v2), into a vector and a sparse matrix over the columns of `MapVariables`.
/// The pattern is found once.
class TriangleSystem {
public:
    explicit TriangleSystem(const MapVariables& variables);

    /// Lower triangle of the sum over all triangles; `matrix_of(t)` gives the 6 x 6 matrix.
    /// Adds `whole_weight` times the squares of the positions among `MapVariables::whole`.
    const Eigen::SparseMatrix<double>& assemble(const std::function<Matrix6(int t)>& matrix_of,
                                                double whole_weight = 0);
    /// Sum over all triangles; `vector_of(t)` gives the 6-vector.
    Eigen::VectorXd gather(const std::function<Vector6(int t)>& vector_of) const;

private:
    struct Term {
        int slot;
        int local;  ///< 6 i + j of the triangle's matrix
        double coefficient;
    };
    const MapVariables& variables_;
    std::vector<Term> whole_terms_;
    std::vector<int> term_start_;
    std::vector<Term> terms_;
    Eigen::SparseMatrix<double> matrix_;
};

}  // namespace kinequad
