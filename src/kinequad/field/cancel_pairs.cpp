#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <queue>
#include <utility>

#include "kinequad/core/index.h"
#include "kinequad/field/period_search.h"

namespace kinequad {
namespace {

using std::numbers::pi;
constexpr int largest_cancel_rounds = 10;
constexpr std::size_t partners = 2;
/// Vertices around a crowded one that are tried for one of its quarters.
constexpr std::size_t places = 24;

struct PathStep {
    int edge = 0;
    int change = 0;  ///< of the period jump
};

struct Candidate {
    int from = 0;  ///< its index rises by one
    int to = 0;    ///< its index falls by one
    std::vector<PathStep> path;
    double stiffness = 0;  ///< energy of the change itself, the angles re-solved
    double gain = 0;
};

/// Edges that leave every vertex, as one list with offsets.
struct VertexEdges {
    std::vector<int> first;
    std::vector<int> edge;
};

VertexEdges list_vertex_edges(const FieldProblem& problem) {
    VertexEdges list;
    list.first.assign(at(problem.vertex_count) + 1, 0);
    for (int e = 0; e < problem.edge_count; ++e) {
        if (problem.right[at(e)] < 0) continue;
        ++list.first[at(problem.tail[at(e)]) + 1];
        ++list.first[at(problem.head[at(e)]) + 1];
    }
    for (std::size_t v = 1; v < list.first.size(); ++v) list.first[v] += list.first[v - 1];
    list.edge.resize(at(list.first.back()));
    std::vector<int> next(list.first.begin(), list.first.end() - 1);
    for (int e = 0; e < problem.edge_count; ++e) {
        if (problem.right[at(e)] < 0) continue;
        list.edge[at(next[at(problem.tail[at(e)])]++)] = e;
        list.edge[at(next[at(problem.head[at(e)])]++)] = e;
    }
    return list;
}

/// Shortest paths over the mesh from one singularity to places for a quarter of it; steps that the
/// field already leans to are short.
class PathFinder {
public:
    explicit PathFinder(const FieldProblem& problem)
        : problem_(problem),
          edges_(list_vertex_edges(problem)),
          distance_(at(problem.vertex_count), std::numeric_limits<double>::infinity()),
          arrival_(at(problem.vertex_count)) {}

    /// From `start`, whose index changes by `sign`, to the nearest `wanted` vertices that `accept`.
    template <typename Accept>
    std::vector<Candidate> find(const SolvedField& field, int start, int sign, std::size_t wanted,
                                const Accept& accept) {
        std::vector<Candidate> found;
        std::vector<int> reached = {start};
        std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>,
                            std::greater<>>
            queue;
        distance_[at(start)] = 0;
        queue.emplace(0, start);
        while (!queue.empty() && found.size() < wanted) {
            const auto [distance, v] = queue.top();
            queue.pop();
            if (distance > distance_[at(v)]) continue;
            if (v != start && accept(v)) {
                const auto [from, to] = sign > 0 ? std::pair(start, v) : std::pair(v, start);
                found.push_back({from, to, trace(start, v, sign), 0, 0});
            }
            for (int i = edges_.first[at(v)]; i < edges_.first[at(v) + 1]; ++i) {
                const int e = edges_.edge[at(i)];
                const bool forward = problem_.tail[at(e)] == v;
                const int change = forward ? sign : -sign;
                const int next = forward ? problem_.head[at(e)] : problem_.tail[at(e)];
                const double length = std::max(0.1, 1 + 2 * change * field.residual[e]);
                if (distance + length >= distance_[at(next)]) continue;
                if (distance_[at(next)] == std::numeric_limits<double>::infinity()) {
                    reached.push_back(next);
                }
                distance_[at(next)] = distance + length;
                arrival_[at(next)] = {e, change};
                queue.emplace(distance + length, next);
            }
        }
        for (const int v : reached) distance_[at(v)] = std::numeric_limits<double>::infinity();
        return found;
    }

    /// To the positive singularities nearest to a negative one; from one of several quarters also
    /// to the regular vertices around it.
    std::vector<Candidate> find_moves(const SolvedField& field, int v) {
        std::vector<Candidate> moves;
        const int index = field.index[v];
        if (index < 0) {
            moves = find(field, v, 1, partners, [&](int u) { return field.index[u] > 0; });
        }
        if (std::abs(index) >= 2) {
            for (Candidate& move : find(field, v, index < 0 ? 1 : -1, places,
                                        [&](int u) { return field.index[u] == 0; })) {
                moves.push_back(std::move(move));
            }
        }
        return moves;
    }

private:
    std::vector<PathStep> trace(int start, int end, int sign) const {
        std::vector<PathStep> path;
        for (int v = end; v != start;) {
            const PathStep& step = arrival_[at(v)];
            path.push_back(step);
            v = step.change == sign ? problem_.tail[at(step.edge)] : problem_.head[at(step.edge)];
        }
        return path;
    }

    const FieldProblem& problem_;
    VertexEdges edges_;
    std::vector<double> distance_;
    std::vector<PathStep> arrival_;
};

/// Energy that a change of periods costs apart from its product with the residuals:
/// `sum pi^2/4 - r^T A^-1 r`.
double stiffness_of(const FieldProblem& problem, const AngleSolver& solver,
                    const std::vector<PathStep>& path) {
    Eigen::VectorXd r = Eigen::VectorXd::Zero(problem.triangle_count);
    for (const PathStep& step : path) {
        r[problem.left[at(step.edge)]] += pi / 2 * step.change;
        r[problem.right[at(step.edge)]] -= pi / 2 * step.change;
    }
    return pi * pi / 4 * static_cast<double>(path.size()) - r.dot(solver.apply_inverse(r));
}

/// A stiffness that no path of `steps` edges is expected to fall below: seven tenths of that of two
/// vertices of the regular triangular lattice at the distance that so many edges span, `pi^2/4 R`,
/// `R = (ln d + gamma + ln(12)/2) / (pi sqrt(3))`. Spares solving for pairs that cannot pay.
double least_stiffness(std::size_t steps) {
    const double distance = std::max(1.0, 0.8 * static_cast<double>(steps));
    return 0.7 * pi / (4 * std::numbers::sqrt3) * (std::log(distance) + 1.8196);
}

double gain_of(const SingularityPrice& price, const SolvedField& field,
               const Candidate& candidate) {
    double gain = candidate.stiffness;
    for (const PathStep& step : candidate.path) {
        gain += pi * step.change * field.residual[step.edge];
    }
    const bool joined = candidate.path.size() == 1 && price.is_tight(candidate.path.front().edge);
    return gain +
           price.change(field.index, field.neighbours, candidate.from, candidate.to, 1, joined);
}

}  // namespace

SolvedField cancel_pairs(const FieldProblem& problem, const AngleSolver& solver,
                         const SingularityPrice& price, SolvedField field, const Context& context) {
    PathFinder finder(problem);
    for (int round = 0; round < largest_cancel_rounds; ++round) {
        std::vector<Candidate> candidates;
        for (int v = 0; v < problem.vertex_count; ++v) {
            if (field.index[v] == 0) continue;
            context.check_cancelled();
            for (Candidate& candidate : finder.find_moves(field, v)) {
                candidate.stiffness = least_stiffness(candidate.path.size());
                if (gain_of(price, field, candidate) >= 0) continue;
                candidate.stiffness = stiffness_of(problem, solver, candidate.path);
                candidate.gain = gain_of(price, field, candidate);
                if (candidate.gain < 0) candidates.push_back(std::move(candidate));
            }
        }
        std::stable_sort(candidates.begin(), candidates.end(),
                         [](const Candidate& x, const Candidate& y) { return x.gain < y.gain; });
        bool improved = false;
        for (const Candidate& candidate : candidates) {
            if (gain_of(price, field, candidate) >= 0) continue;
            FieldState state = field.state;
            for (const PathStep& step : candidate.path) {
                state.period_jump[step.edge] += step.change;
            }
            SolvedField next = solve_field(problem, solver, price, std::move(state));
            if (next.cost >= field.cost) continue;
            field = std::move(next);
            improved = true;
        }
        if (!improved) break;
    }
    return field;
}

}  // namespace kinequad
