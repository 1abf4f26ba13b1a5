#pragma once

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <cstdint>

namespace kinequad {

/// Approximate minimum degree ordering [Amestoy, Davis and Duff 1996] as `Eigen::AMDOrdering`,
/// whose place it takes in Eigen's factorisations, but counted in 64 bits: it adds up column
/// numbers, which overflows 32 bits where a column of a matrix with a million of them has a few
/// thousand entries, and reads out of bounds then.
class MinimumDegreeOrder {
public:
    using PermutationType = Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int>;

    /// The permutation whose inverse puts the rows of `matrix` (n x n, or the view of a symmetric
    /// one) into an order that leaves its factor sparse. It depends on the pattern alone.
    template <class Matrix>
    void operator()(const Matrix& matrix, PermutationType& order) const {
        using Index = std::int64_t;
        Eigen::SparseMatrix<double, Eigen::ColMajor, Index> wide;
        {
            Eigen::SparseMatrix<typename Matrix::Scalar> whole;
            whole = matrix;
            wide = whole.cwiseAbs();
        }
        Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, Index> wide_order;
        Eigen::AMDOrdering<Index>()(wide, wide_order);
        order.indices() = wide_order.indices().cast<int>();
    }
};

}  // namespace kinequad
