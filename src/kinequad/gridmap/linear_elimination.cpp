#include "kinequad/gridmap/linear_elimination.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "kinequad/core/index.h"

namespace kinequad {
namespace {

/// Whether `sum`, of which `part` is one of two terms, is zero but for rounding errors.
/// Coefficients are fractions of small whole numbers, so that whatever is left of a sum is not much
/// smaller than its terms.
bool cancels(double part, double sum) { return std::abs(sum) <= 1e-9 * std::abs(part); }
bool cancels(long, long sum) { return sum == 0; }

}  // namespace

template <class Number>
LinearForm<Number> add_scaled(const LinearForm<Number>& a, Number factor,
                              const LinearForm<Number>& b) {
    LinearForm<Number> sum;
    sum.reserve(a.size() + b.size());
    std::size_t i = 0;
    std::size_t j = 0;
    while (i < a.size() || j < b.size()) {
        if (j == b.size() || (i < a.size() && a[i].first < b[j].first)) {
            sum.push_back(a[i++]);
        } else if (i == a.size() || b[j].first < a[i].first) {
            sum.emplace_back(b[j].first, factor * b[j].second);
            ++j;
        } else {
            const Number value = a[i].second + factor * b[j].second;
            if (!cancels(a[i].second, value)) sum.emplace_back(a[i].first, value);
            ++i;
            ++j;
        }
    }
    return sum;
}

template LinearForm<long> add_scaled(const LinearForm<long>&, long, const LinearForm<long>&);
template LinearForm<double> add_scaled(const LinearForm<double>&, double,
                                       const LinearForm<double>&);

namespace {

/// Variables that have been expressed by others, with their expressions kept up to date lazily.
template <class Number>
class Substitution {
public:
    explicit Substitution(int variable_count)
        : definition_(static_cast<std::size_t>(variable_count)),
          is_defined_(static_cast<std::size_t>(variable_count), 0) {}

    int new_variable() {
        definition_.emplace_back();
        is_defined_.push_back(0);
        return static_cast<int>(definition_.size()) - 1;
    }
    int count() const { return static_cast<int>(definition_.size()); }
    bool is_defined(int variable) const { return is_defined_[at(variable)] != 0; }

    void define(int variable, LinearForm<Number> form) {
        is_defined_[at(variable)] = 1;
        definition_[at(variable)] = std::move(form);
    }

    /// The form in variables that are not defined.
    LinearForm<Number> expand(const LinearForm<Number>& form) {
        LinearForm<Number> kept;
        LinearForm<Number> result;
        for (const auto& term : form) {
            if (!is_defined(term.first)) kept.push_back(term);
        }
        result = std::move(kept);
        for (const auto& [variable, coefficient] : form) {
            if (is_defined(variable)) result = add_scaled(result, coefficient, resolved(variable));
        }
        return result;
    }

private:
    /// Brings the definition of a variable up to date, remembering the result. Definitions refer to
    /// variables defined later only, so that the explicit stack below ends.
    const LinearForm<Number>& resolved(int variable) {
        std::vector<int> stack = {variable};
        while (!stack.empty()) {
            auto& form = definition_[at(stack.back())];
            int pending = -1;
            bool stale = false;
            for (const auto& term : form) {
                if (!is_defined(term.first)) continue;
                stale = true;
                const auto& inner = definition_[at(term.first)];
                const bool inner_stale = std::any_of(
                    inner.begin(), inner.end(), [&](const auto& t) { return is_defined(t.first); });
                if (inner_stale) {
                    pending = term.first;
                    break;
                }
            }
            if (pending >= 0) {
                stack.push_back(pending);
                continue;
            }
            if (stale) {
                LinearForm<Number> fresh;
                for (const auto& term : form) {
                    if (!is_defined(term.first)) fresh.push_back(term);
                }
                for (const auto& [inner, coefficient] : form) {
                    if (is_defined(inner)) {
                        fresh = add_scaled(fresh, coefficient, definition_[at(inner)]);
                    }
                }
                form = std::move(fresh);
            }
            stack.pop_back();
        }
        return definition_[at(variable)];
    }

    std::vector<LinearForm<Number>> definition_;
    std::vector<char> is_defined_;
};

template <class Number>
Elimination<Number> collect(Substitution<Number>& substitution, int variable_count) {
    Elimination<Number> result;
    std::vector<int> free_number(static_cast<std::size_t>(substitution.count()), -1);
    for (int v = 0; v < substitution.count(); ++v) {
        if (substitution.is_defined(v)) continue;
        free_number[at(v)] = result.free_count++;
        result.free_variable.push_back(v < variable_count ? v : -1);
    }
    for (int v = 0; v < variable_count; ++v) {
        LinearForm<Number> form = substitution.expand({{v, Number{1}}});
        for (auto& term : form) term.first = free_number[at(term.first)];
        result.solution.push_back(std::move(form));
    }
    return result;
}

/// `-(row - row[pivot]) / coefficient` without the pivot.
template <class Number>
LinearForm<Number> solve_for(const LinearForm<Number>& row, std::size_t pivot) {
    LinearForm<Number> form;
    for (std::size_t i = 0; i < row.size(); ++i) {
        if (i != pivot) form.emplace_back(row[i].first, -row[i].second / row[pivot].second);
    }
    return form;
}

}  // namespace

Elimination<double> eliminate_reals(int variable_count, const std::vector<LinearForm<double>>& rows,
                                    const std::vector<int>& priority) {
    Substitution<double> substitution(variable_count);
    for (const auto& given : rows) {
        const LinearForm<double> row = substitution.expand(given);
        if (row.empty()) continue;
        std::size_t pivot = 0;
        for (std::size_t i = 1; i < row.size(); ++i) {
            const int here = priority[at(row[i].first)];
            const int best = priority[at(row[pivot].first)];
            const bool is_larger = std::abs(row[i].second) > std::abs(row[pivot].second);
            if (here < best || (here == best && is_larger)) pivot = i;
        }
        substitution.define(row[pivot].first, solve_for(row, pivot));
    }
    return collect(substitution, variable_count);
}

Elimination<long> eliminate_integers(int variable_count, const std::vector<LinearForm<long>>& rows,
                                     const std::vector<int>& priority) {
    Substitution<long> substitution(variable_count);
    const auto priority_of = [&](int v) {
        // New variables stand for combinations of others: keep them free where there is a choice.
        return v < variable_count ? priority[at(v)] : 1 << 20;
    };
    for (const auto& given : rows) {
        LinearForm<long> row = substitution.expand(given);
        while (!row.empty()) {
            long divisor = 0;
            for (const auto& term : row) divisor = std::gcd(divisor, term.second);
            for (auto& term : row) term.second /= divisor;
            std::size_t unit = row.size();
            std::size_t least = 0;
            for (std::size_t i = 0; i < row.size(); ++i) {
                const long size = std::labs(row[i].second);
                if (size == 1 && (unit == row.size() ||
                                  priority_of(row[i].first) < priority_of(row[unit].first))) {
                    unit = i;
                }
                if (size < std::labs(row[least].second)) least = i;
            }
            if (unit < row.size()) {
                substitution.define(row[unit].first, solve_for(row, unit));
                break;
            }
            // x := x_least + sum floor(c_i / c_least) x_i replaces x_least.
            const int fresh = substitution.new_variable();
            LinearForm<long> form = {{fresh, 1}};
            LinearForm<long> reduced = {{fresh, row[least].second}};
            for (std::size_t i = 0; i < row.size(); ++i) {
                if (i == least) continue;
                const long quotient = row[i].second / row[least].second;
                form = add_scaled(form, -quotient, LinearForm<long>{{row[i].first, 1}});
                reduced = add_scaled(reduced, row[i].second - quotient * row[least].second,
                                     LinearForm<long>{{row[i].first, 1}});
            }
            std::erase_if(reduced, [](const auto& term) { return term.second == 0; });
            std::erase_if(form, [](const auto& term) { return term.second == 0; });
            substitution.define(row[least].first, std::move(form));
            row = std::move(reduced);
        }
    }
    return collect(substitution, variable_count);
}

}  // namespace kinequad
