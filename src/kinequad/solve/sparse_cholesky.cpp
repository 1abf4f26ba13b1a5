#include "kinequad/solve/sparse_cholesky.h"

#include <Eigen/SparseCholesky>
#include <cmath>

#include "kinequad/core/error.h"
#include "kinequad/solve/minimum_degree_order.h"

namespace kinequad {

template <class Scalar>
struct SparseCholesky<Scalar>::Factor {
    Eigen::SimplicialLDLT<Matrix, Eigen::Lower, MinimumDegreeOrder> ldlt;
};

template <class Scalar>
SparseCholesky<Scalar>::SparseCholesky(const Matrix& A) : factor_(std::make_unique<Factor>()) {
    if (A.rows() == 0) return;
    factor_->ldlt.compute(A);
    bool positive = factor_->ldlt.info() == Eigen::Success;
    if (positive) {
        const auto pivots = factor_->ldlt.vectorD();
        for (Eigen::Index i = 0; i < pivots.size() && positive; ++i) {
            positive = std::isfinite(std::real(pivots[i])) && std::real(pivots[i]) > 0;
        }
    }
    if (!positive) {
        throw Error(ExitCode::internal_failure,
                    "sparse Cholesky: the matrix is not positive definite");
    }
}

template <class Scalar>
SparseCholesky<Scalar>::~SparseCholesky() = default;
template <class Scalar>
SparseCholesky<Scalar>::SparseCholesky(SparseCholesky&&) noexcept = default;
template <class Scalar>
SparseCholesky<Scalar>& SparseCholesky<Scalar>::operator=(SparseCholesky&&) noexcept = default;

template <class Scalar>
typename SparseCholesky<Scalar>::Vector SparseCholesky<Scalar>::solve(const Vector& b) const {
    if (b.size() == 0) return b;
    return factor_->ldlt.solve(b);
}

template class SparseCholesky<double>;
template class SparseCholesky<Complex>;

}  // namespace kinequad
