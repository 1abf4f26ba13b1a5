#pragma once

#include "kinequad/field/angle_solver.h"

namespace kinequad {

/// A solved field with everything that the search over its periods asks for. Internal to this
/// stage.
struct SolvedField {
    FieldState state;
    Eigen::VectorXd residual;  ///< e: w_e
    Eigen::VectorXi index;     ///< n: quarters
    double energy = 0;
    double cost = 0;  ///< energy plus the price of the singularities
};

/// What singularities cost in energy, by their index.
class SingularityPrice {
public:
    SingularityPrice(const Topology& topology, double singularity_cost);
    double operator()(int vertex, int index) const;
    double sum(const Eigen::VectorXi& index) const;

private:
    std::vector<bool> boundary_;
    double cost_;
};

/// Re-solves the angles for the periods of `state` and evaluates the result.
SolvedField solve_field(const FieldProblem& problem, const AngleSolver& solver,
                        const SingularityPrice& price, FieldState state);

/// Changes single period jumps, many at a time where they do not touch, as long as the cost falls.
SolvedField improve_periods(const FieldProblem& problem, const AngleSolver& solver,
                            const SingularityPrice& price, SolvedField field,
                            const Context& context);

/// Cancels negative singularities against near positive ones where that lowers the cost.
SolvedField cancel_pairs(const FieldProblem& problem, const AngleSolver& solver,
                         const SingularityPrice& price, SolvedField field, const Context& context);

}  // namespace kinequad
