#include "kinequad/gridmap/plane_form.h"

namespace kinequad {

PlaneForm turn(const PlaneForm& form, int quarters) {
    PlaneForm result = form;
    for (PlaneForm::Term& term : result.terms) {
        const int u = term.u;
        const int v = term.v;
        switch (quarters & 3) {
            case 1:
                term.u = -v;
                term.v = u;
                break;
            case 2:
                term.u = -u;
                term.v = -v;
                break;
            case 3:
                term.u = v;
                term.v = -u;
                break;
            default:
                break;
        }
    }
    return result;
}

PlaneForm operator+(const PlaneForm& a, const PlaneForm& b) {
    PlaneForm sum;
    sum.terms.reserve(a.terms.size() + b.terms.size());
    std::size_t i = 0;
    std::size_t j = 0;
    while (i < a.terms.size() || j < b.terms.size()) {
        if (j == b.terms.size() ||
            (i < a.terms.size() && a.terms[i].unknown < b.terms[j].unknown)) {
            sum.terms.push_back(a.terms[i++]);
        } else if (i == a.terms.size() || b.terms[j].unknown < a.terms[i].unknown) {
            sum.terms.push_back(b.terms[j++]);
        } else {
            const PlaneForm::Term term{a.terms[i].unknown, a.terms[i].u + b.terms[j].u,
                                       a.terms[i].v + b.terms[j].v};
            if (term.u != 0 || term.v != 0) sum.terms.push_back(term);
            ++i;
            ++j;
        }
    }
    return sum;
}

}  // namespace kinequad
