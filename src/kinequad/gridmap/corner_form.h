#pragma once

#include "kinequad/gridmap/linear_elimination.h"

namespace kinequad {

/// The coordinates of a corner as linear forms in some variables.
template <class Number>
struct CornerForm {
    LinearForm<Number> u;
    LinearForm<Number> v;
};

/// The form turned counter-clockwise by `quarters` quarter turns.
template <class Number>
CornerForm<Number> turned(const CornerForm<Number>& form, int quarters) {
    const auto negated = [](const LinearForm<Number>& part) {
        return add_scaled(LinearForm<Number>{}, Number{-1}, part);
    };
    switch (quarters & 3) {
        case 1:
            return {negated(form.v), form.u};
        case 2:
            return {negated(form.u), negated(form.v)};
        case 3:
            return {form.v, negated(form.u)};
        default:
            return form;
    }
}

template <class Number>
CornerForm<Number> add(const CornerForm<Number>& a, const CornerForm<Number>& b) {
    return {add_scaled(a.u, Number{1}, b.u), add_scaled(a.v, Number{1}, b.v)};
}

}  // namespace kinequad
