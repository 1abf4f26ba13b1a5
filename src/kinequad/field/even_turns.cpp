#include "kinequad/field/even_turns.h"

#include <algorithm>
#include <numbers>

#include "kinequad/core/index.h"
#include "kinequad/solve/sparse_cholesky.h"

namespace kinequad {
namespace {

constexpr double largest_turn = 35 * std::numbers::pi / 180;

/// Chains of consecutive mirror half-edges; a closed one is a whole boundary loop.
struct Chain {
    std::vector<int> half_edges;
    bool is_closed = false;
};

std::vector<Chain> mirror_chains(const Topology& topology, const std::vector<bool>& is_mirror) {
    std::vector<Chain> chains;
    for (std::vector<int> loop : boundary_loops(topology)) {
        const auto on_mirror = [&](int h) { return is_mirror[at(topology.edge[at(h)])]; };
        const auto gap =
            std::find_if(loop.begin(), loop.end(), [&](int h) { return !on_mirror(h); });
        if (gap == loop.end()) {
            chains.push_back({std::move(loop), true});
            continue;
        }
        std::rotate(loop.begin(), gap, loop.end());
        Chain chain;
        for (const int h : loop) {
            if (on_mirror(h)) {
                chain.half_edges.push_back(h);
            } else if (!chain.half_edges.empty()) {
                chains.push_back(std::move(chain));
                chain = {};
            }
        }
        if (!chain.half_edges.empty()) chains.push_back(std::move(chain));
    }
    return chains;
}

/// The turns against the edges of one chain that minimise `sum_v (bend_v + x_(i+1) - x_i)^2 / l_v +
/// sum_i l_i x_i^2 / reach^2`, `bend_v` the angle by which the chain turns at its vertex v.
Eigen::VectorXd solve_chain(const Topology& topology, const IntrinsicMetric& metric,
                            const Eigen::VectorXd& bend, const Chain& chain, double reach) {
    const auto count = static_cast<Eigen::Index>(chain.half_edges.size());
    const auto length = [&](Eigen::Index i) {
        const int h = chain.half_edges[at(i)];
        return std::max(metric.edge_length[topology.edge[at(h)]], 1e-6 * reach);
    };
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
    for (Eigen::Index i = 0; i < count; ++i) {
        entries.emplace_back(i, i, length(i) / (reach * reach));
        const Eigen::Index next = (i + 1) % count;
        if (next == i || (next == 0 && !chain.is_closed)) continue;
        const double weight = 2 / (length(i) + length(next));
        const int v = topology.target(chain.half_edges[at(i)]);
        entries.emplace_back(i, i, weight);
        entries.emplace_back(next, next, weight);
        entries.emplace_back(std::max(i, next), std::min(i, next), -weight);
        right[next] -= weight * bend[v];
        right[i] += weight * bend[v];
    }
    SparseCholesky<double>::Matrix A(count, count);
    A.setFromTriplets(entries.begin(), entries.end());
    return SparseCholesky<double>(A).solve(right);
}

}  // namespace

std::vector<double> even_turns(const Topology& topology, const IntrinsicMetric& metric,
                               const CrossFieldOptions& options) {
    std::vector<double> turned(at(topology.edge_count), 0);
    if (options.mirror_edges.empty() || !(options.edge_length > 0)) return turned;
    std::vector<bool> is_mirror(at(topology.edge_count), false);
    for (const int e : options.mirror_edges) is_mirror[at(e)] = true;
    const Eigen::VectorXd bend = angle_defects(topology, metric);
    for (const Chain& chain : mirror_chains(topology, is_mirror)) {
        const Eigen::VectorXd x =
            solve_chain(topology, metric, bend, chain, 1.5 * options.edge_length);
        for (std::size_t i = 0; i < chain.half_edges.size(); ++i) {
            turned[at(topology.edge[at(chain.half_edges[i])])] =
                std::clamp(x[static_cast<Eigen::Index>(i)], -largest_turn, largest_turn);
        }
    }
    return turned;
}

}  // namespace kinequad
