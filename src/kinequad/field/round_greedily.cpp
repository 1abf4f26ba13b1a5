#include "kinequad/field/round_greedily.h"

#include <array>
#include <cmath>
#include <numbers>
#include <queue>

#include "kinequad/core/index.h"
#include "kinequad/solve/sparse_cholesky.h"

namespace kinequad {
namespace {

/// Changes of an angle below this, in radians, are not passed on to the neighbours.
constexpr double local_tolerance = 1e-4;
/// Angles that one rounding may re-solve locally.
constexpr int local_budget = 400;
/// Roundings whose local re-solve did not settle before everything is solved again: at first, and
/// by how much more the next time. What is still free then weighs ever less.
constexpr double first_patience = 4;
constexpr double patience_growth = 1.03;

class GreedyRounding {
public:
    explicit GreedyRounding(const FieldProblem& problem)
        : problem_(problem),
          sides_(at(problem.triangle_count), {-1, -1, -1}),
          rigid_(problem.fixed),
          angle_(problem.target),
          period_jump_(Eigen::VectorXi::Zero(problem.edge_count)),
          decided_(at(problem.edge_count), false),
          version_(at(problem.edge_count), 0),
          waiting_(at(problem.triangle_count), false) {
        std::vector<int> used(at(problem.triangle_count), 0);
        for (int e = 0; e < problem.edge_count; ++e) {
            if (problem.right[at(e)] < 0) continue;
            for (const int t : {problem.left[at(e)], problem.right[at(e)]}) {
                sides_[at(t)][at(used[at(t)]++)] = e;
            }
        }
        grow_forest();
    }

    FieldState run(const Context& context) {
        for (int e = 0; e < problem_.edge_count; ++e) {
            if (problem_.right[at(e)] >= 0 && !decided_[at(e)]) offer(e);
        }
        double patience = first_patience;
        int unsettled = 0;
        int rounds = 0;
        while (!queue_.empty()) {
            const Offer offer = queue_.top();
            queue_.pop();
            if (decided_[at(offer.edge)] || offer.version != version_[at(offer.edge)]) continue;
            if (++rounds % 1024 == 0) context.check_cancelled();
            decide(offer.edge, static_cast<int>(std::lround(relaxed_period(offer.edge))));
            if (!settle_locally(offer.edge)) ++unsettled;
            if (unsettled > patience) {
                unsettled = 0;
                patience *= patience_growth;
                context.check_cancelled();
                solve_globally();
            }
        }
        return {angle_, period_jump_};
    }

private:
    struct Offer {
        double error = 0;
        int edge = 0;
        int version = 0;
        bool operator<(const Offer& other) const {
            return error != other.error ? error > other.error : edge > other.edge;
        }
    };

    int across(int e, int t) const {
        return problem_.left[at(e)] == t ? problem_.right[at(e)] : problem_.left[at(e)];
    }

    /// The angle of `t` for which edge `e` has no residual.
    double asked_by_edge(int e, int t) const {
        const double turn = problem_.kappa[e] + quarter * period_jump_[e];
        return problem_.left[at(e)] == t ? angle_[problem_.right[at(e)]] - turn
                                         : angle_[problem_.left[at(e)]] + turn;
    }

    double relaxed_period(int e) const {
        return (angle_[problem_.right[at(e)]] - angle_[problem_.left[at(e)]] - problem_.kappa[e]) /
               quarter;
    }

    void decide(int e, int period) {
        decided_[at(e)] = true;
        period_jump_[e] = period;
    }

    void offer(int e) {
        const double period = relaxed_period(e);
        queue_.push({std::abs(period - std::round(period)), e, ++version_[at(e)]});
    }

    void grow_forest() {
        std::vector<bool> reached(at(problem_.triangle_count), false);
        std::queue<int> front;
        std::vector<bool> rooted = problem_.anchored;
        for (int t = 0; t < problem_.triangle_count; ++t) {
            const std::size_t c = at(problem_.component[at(t)]);
            if (problem_.fixed[at(t)]) angle_[t] = problem_.fixed_angle[t];
            if (!rooted[c]) {
                rooted[c] = true;
                rigid_[at(t)] = true;
            }
            if (rigid_[at(t)] || problem_.weight[t] > 0) {
                reached[at(t)] = true;
                front.push(t);
            }
        }
        while (!front.empty()) {
            const int t = front.front();
            front.pop();
            for (const int e : sides_[at(t)]) {
                if (e < 0) continue;
                const int other = across(e, t);
                if (reached[at(other)]) continue;
                reached[at(other)] = true;
                decide(e, 0);
                angle_[other] = asked_by_edge(e, other);
                front.push(other);
            }
        }
    }

    /// Gauss-Seidel over what the newly decided edge disturbs; false where the budget ends before
    /// it is calm.
    bool settle_locally(int start) {
        std::queue<int> front;
        const auto disturb = [&](int t) {
            if (rigid_[at(t)] || waiting_[at(t)]) return;
            waiting_[at(t)] = true;
            front.push(t);
        };
        disturb(problem_.left[at(start)]);
        disturb(problem_.right[at(start)]);
        int spent = 0;
        for (; !front.empty() && spent < local_budget; ++spent) {
            const int t = front.front();
            front.pop();
            waiting_[at(t)] = false;
            double weight = problem_.weight[t];
            double sum = weight * problem_.target[t];
            for (const int e : sides_[at(t)]) {
                if (e < 0 || !decided_[at(e)]) continue;
                weight += 1;
                sum += asked_by_edge(e, t);
            }
            const double change = sum / weight - angle_[t];
            if (std::abs(change) < local_tolerance) continue;
            angle_[t] += change;
            for (const int e : sides_[at(t)]) {
                if (e < 0) continue;
                if (decided_[at(e)]) {
                    disturb(across(e, t));
                } else {
                    offer(e);
                }
            }
        }
        const bool calm = front.empty();
        for (; !front.empty(); front.pop()) waiting_[at(front.front())] = false;
        return calm;
    }

    void solve_globally() {
        std::vector<int> unknown(at(problem_.triangle_count), -1);
        int count = 0;
        for (int t = 0; t < problem_.triangle_count; ++t) {
            if (!rigid_[at(t)]) unknown[at(t)] = count++;
        }
        std::vector<Eigen::Triplet<double>> entries;
        Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
        for (int t = 0; t < problem_.triangle_count; ++t) {
            const int i = unknown[at(t)];
            if (i < 0) continue;
            double diagonal = problem_.weight[t];
            right[i] += problem_.weight[t] * (problem_.target[t] - angle_[t]);
            for (const int e : sides_[at(t)]) {
                if (e < 0 || !decided_[at(e)]) continue;
                diagonal += 1;
                right[i] += asked_by_edge(e, t) - angle_[t];
                const int j = unknown[at(across(e, t))];
                if (j >= 0 && j < i) entries.emplace_back(i, j, -1);
            }
            entries.emplace_back(i, i, diagonal);
        }
        Eigen::SparseMatrix<double> A(count, count);
        A.setFromTriplets(entries.begin(), entries.end());
        const Eigen::VectorXd change = SparseCholesky<double>(A).solve(right);
        for (int t = 0; t < problem_.triangle_count; ++t) {
            if (unknown[at(t)] >= 0) angle_[t] += change[unknown[at(t)]];
        }
        for (int e = 0; e < problem_.edge_count; ++e) {
            if (problem_.right[at(e)] >= 0 && !decided_[at(e)]) offer(e);
        }
    }

    const FieldProblem& problem_;
    std::vector<std::array<int, 3>>
        sides_;                ///< interior edges of a triangle, -1 where there is none
    std::vector<bool> rigid_;  ///< angle does not change
    Eigen::VectorXd angle_;
    Eigen::VectorXi period_jump_;
    std::vector<bool> decided_;
    std::vector<int> version_;  ///< of the latest offer of an edge
    std::vector<bool> waiting_;
    std::priority_queue<Offer> queue_;
};

}  // namespace

FieldState round_greedily(const FieldProblem& problem, const Context& context) {
    return GreedyRounding(problem).run(context);
}

}  // namespace kinequad
