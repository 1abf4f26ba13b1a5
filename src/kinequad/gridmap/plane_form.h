#pragma once

#include <Eigen/Core>
#include <vector>

#include "kinequad/core/types.h"

namespace kinequad {

/// A vector of the plane as an integer linear form in unknowns y: sparse, sorted by unknown.
struct PlaneForm {
    struct Term {
        int unknown;
        int u;
        int v;
    };
    std::vector<Term> terms;

    bool is_zero() const { return terms.empty(); }
    /// Its value for `y`.
    Complex at(const Eigen::VectorXd& y) const {
        double u = 0;
        double v = 0;
        for (const Term& term : terms) {
            u += term.u * y[term.unknown];
            v += term.v * y[term.unknown];
        }
        return {u, v};
    }
};

/// The form turned counter-clockwise by `quarters` quarter turns.
PlaneForm turn(const PlaneForm& form, int quarters);
PlaneForm operator+(const PlaneForm& a, const PlaneForm& b);

}  // namespace kinequad
