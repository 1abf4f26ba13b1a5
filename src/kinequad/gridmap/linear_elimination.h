#pragma once

#include <utility>
#include <vector>

namespace kinequad {

/// A sparse linear form `sum coefficient * variable`, sorted by variable, without zeros.
template <class Number>
using LinearForm = std::vector<std::pair<int, Number>>;

/// `a + factor * b`.
template <class Number>
LinearForm<Number> add_scaled(const LinearForm<Number>& a, Number factor,
                              const LinearForm<Number>& b);

/// All variables of a homogeneous linear system in terms of those left free.
template <class Number>
struct Elimination {
    int free_count = 0;
    std::vector<int> free_variable;  ///< free_count: original variable of a free one; -1 where
                                     ///< it is a new integer variable
    std::vector<LinearForm<Number>> solution;  ///< a form in the free variables for every variable
};

/// Solves `rows` (each a form that vanishes) over the reals. In every row the variable with the
/// lowest `priority` (of those, the one with the largest coefficient) is expressed by the others;
/// rows are used in their order.
Elimination<double> eliminate_reals(int variable_count, const std::vector<LinearForm<double>>& rows,
                                    const std::vector<int>& priority);

/// Solves `rows` over the integers: the solutions are exactly the integer combinations of the free
/// variables, a lattice basis. Among the variables with coefficient +-1 the one with the lowest
/// `priority` is expressed by the others; where there is none, variables are changed by unimodular
/// steps until there is (Hermite's reduction of one row).
Elimination<long> eliminate_integers(int variable_count, const std::vector<LinearForm<long>>& rows,
                                     const std::vector<int>& priority);

}  // namespace kinequad
