#pragma once

#include <Eigen/SparseCore>
#include <memory>

#include "kinequad/core/types.h"

namespace kinequad {

/// The factor `L D L^H` of a sparse, positive definite matrix, made once and used for many
/// right-hand sides. `Scalar` is `double` or `Complex` (Hermitian). The order of elimination is
/// approximate minimum degree [Amestoy, Davis and Duff 1996]; it depends on the pattern alone.
template <class Scalar>
class SparseCholesky {
public:
    using Matrix = Eigen::SparseMatrix<Scalar>;
    using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

    /// Factors `A` (n x n); only its lower triangle is read. Throws `Error` (internal failure)
    /// where a pivot is not a positive number, as in a matrix that is not positive definite.
    explicit SparseCholesky(const Matrix& A);
    ~SparseCholesky();
    SparseCholesky(SparseCholesky&&) noexcept;
    SparseCholesky& operator=(SparseCholesky&&) noexcept;

    /// The solution `x` (n) of `A x = b` (n). Safe to call from several threads at once.
    Vector solve(const Vector& b) const;

private:
    struct Factor;
    std::unique_ptr<Factor> factor_;
};

extern template class SparseCholesky<double>;
extern template class SparseCholesky<Complex>;

}  // namespace kinequad
