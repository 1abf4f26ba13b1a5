#pragma once

#include "kinequad/core/index.h"
#include "kinequad/field/angle_solver.h"

namespace kinequad {

/// What singularities cost in energy: by their index, and more where a mesh edge joins two of them,
/// as no integer-grid map has room there.
class SingularityPrice {
public:
    /// `tight` (e) tells which mesh edges are short, empty for none; `cost_factor` (n) multiplies
    /// `singularity_cost` at vertices inside, empty for 1.
    SingularityPrice(const FieldProblem& problem, const Topology& topology, double singularity_cost,
                     double adjacency_cost = 0, std::vector<bool> tight = {},
                     const std::vector<double>& cost_factor = {});
    /// Price of all singularities (n).
    double sum(const Eigen::VectorXi& index) const;
    /// Number of singular vertices across the short edges of every vertex (n).
    Eigen::VectorXi singular_neighbours(const Eigen::VectorXi& index) const;
    /// What the price changes by when the index of `from` rises by `change` and that of `to` falls
    /// by it.
    double change(const Eigen::VectorXi& index, const Eigen::VectorXi& neighbours, int from, int to,
                  int change, bool joined) const;

    bool is_tight(int edge) const { return !tight_.empty() && tight_[at(edge)]; }

private:
    double vertex_price(int vertex, int index) const;

    const FieldProblem& problem_;
    std::vector<bool> boundary_;
    std::vector<double> singularity_cost_;  ///< n
    double adjacency_cost_;
    std::vector<bool> tight_;
};

/// A solved field with everything that the search over its periods asks for. Internal to this
/// stage.
struct SolvedField {
    FieldState state;
    Eigen::VectorXd residual;    ///< e: w_e
    Eigen::VectorXi index;       ///< n: quarters
    Eigen::VectorXi neighbours;  ///< n: singular vertices across the short edges of a vertex
    double energy = 0;
    double cost = 0;  ///< energy plus the price of the singularities
};

/// Re-solves the angles for the periods of `state` and evaluates the result.
SolvedField solve_field(const FieldProblem& problem, const AngleSolver& solver,
                        const SingularityPrice& price, FieldState state);

/// Changes single period jumps, many at a time where they do not touch, as long as the cost falls.
SolvedField improve_periods(const FieldProblem& problem, const AngleSolver& solver,
                            const SingularityPrice& price, SolvedField field,
                            const Context& context);

/// Cancels negative singularities against near positive ones, and takes those of several quarters
/// apart, where that lowers the cost.
SolvedField cancel_pairs(const FieldProblem& problem, const AngleSolver& solver,
                         const SingularityPrice& price, SolvedField field, const Context& context);

}  // namespace kinequad
