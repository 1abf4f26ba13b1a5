#pragma once

#include "kinequad/field/field_problem.h"
#include "kinequad/solve/sparse_cholesky.h"

namespace kinequad {

/// Finds the angles of least energy for given period jumps. The matrix does not depend on the
/// periods or the connection, so it is factored once. Internal to this stage.
class AngleSolver {
public:
    explicit AngleSolver(const FieldProblem& problem);

    /// The state with the periods of `state` and the best angles; soft targets are taken at the
    /// quarter turn nearest to the angles of `state`.
    FieldState solve(const FieldProblem& problem, FieldState state) const;

    /// `A^-1 r` over all triangles (m), 0 where the cross is given; `r` (m) is read elsewhere only.
    Eigen::VectorXd apply_inverse(const Eigen::VectorXd& r) const;

private:
    std::vector<int> unknown_;  ///< m: row in the system, -1 where the cross is given
    std::vector<int> triangle_;
    SparseCholesky<double> factor_;
};

}  // namespace kinequad
