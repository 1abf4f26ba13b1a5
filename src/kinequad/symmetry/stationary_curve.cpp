#include "kinequad/symmetry/stationary_curve.h"

#include <algorithm>
#include <cmath>

#include "kinequad/core/index.h"

namespace kinequad {
namespace {

/// Where the curve crosses one triangle.
struct Crossing {
    int enter = -1;  ///< half-edge of the triangle
    int leave = -1;
};

struct Chain {
    std::vector<Crossing> crossings;
    bool is_closed = false;
    double length = 0;
};

class Tracer {
public:
    Tracer(const Topology& topology, const IntrinsicMetric& metric, const Eigen::VectorXd& height)
        : topology_(topology), metric_(metric), height_(height) {}

    bool is_positive(int v) const { return height_[v] > 0; }

    /// The half-edges of triangle `t` that the curve crosses; -1 where it does not.
    Crossing crossing(int t) const {
        Crossing result;
        for (int k = 0; k < 3; ++k) {
            const int h = 3 * t + k;
            const bool from = is_positive(topology_.origin[at(h)]);
            const bool to = is_positive(topology_.target(h));
            if (from && !to) result.enter = h;
            if (!from && to) result.leave = h;
        }
        return result;
    }

    /// The point of the curve on a half-edge, in the half-edge's triangle.
    SurfacePoint point_on(int h) const {
        const double a = height_[topology_.origin[at(h)]];
        const double b = height_[topology_.target(h)];
        // Away from the vertices, so that no two points of the curve coincide.
        const double share = std::clamp(a / (a - b), 1e-6, 1 - 1e-6);
        SurfacePoint point{h / 3, Vector3::Zero()};
        point.barycentric[h % 3] = 1 - share;
        point.barycentric[Topology::next(h) % 3] = share;
        return point;
    }

    /// The segment in a triangle's frame.
    Vector2 segment(const Crossing& c) const {
        const auto corners = lay_out_triangle(side_lengths(topology_, metric_, c.enter / 3));
        return corners * (point_on(c.leave).barycentric - point_on(c.enter).barycentric);
    }

    std::vector<Chain> trace_all() const {
        std::vector<Chain> chains;
        std::vector<bool> visited(at(topology_.triangle_count), false);
        // Chains that come in over the boundary first: what is left is closed.
        for (const bool only_open : {true, false}) {
            for (int t = 0; t < topology_.triangle_count; ++t) {
                if (visited[at(t)]) continue;
                const Crossing first = crossing(t);
                if (first.enter < 0 || (only_open && topology_.twin[at(first.enter)] >= 0))
                    continue;
                chains.push_back(trace(t, visited));
                chains.back().is_closed = !only_open;
            }
        }
        return chains;
    }

private:
    Chain trace(int t, std::vector<bool>& visited) const {
        Chain chain;
        while (!visited[at(t)]) {
            visited[at(t)] = true;
            chain.crossings.push_back(crossing(t));
            chain.length += segment(chain.crossings.back()).norm();
            const int other = topology_.twin[at(chain.crossings.back().leave)];
            if (other < 0) break;
            t = other / 3;
        }
        return chain;
    }

    const Topology& topology_;
    const IntrinsicMetric& metric_;
    const Eigen::VectorXd& height_;
};

/// Signs of all vertices when only the edges on `chains` change the sign.
Eigen::VectorXd mend_signs(const Topology& topology, const Eigen::VectorXd& height,
                           const std::vector<Chain>& chains) {
    std::vector<bool> is_crossed(at(topology.edge_count), false);
    std::vector<int> sign(at(topology.vertex_count), 0);
    std::vector<int> stack;
    const auto seed = [&](int v, int value) {
        if (sign[at(v)] != 0) return;
        sign[at(v)] = value;
        stack.push_back(v);
    };
    for (const Chain& chain : chains) {
        for (const Crossing& c : chain.crossings) {
            is_crossed[at(topology.edge[at(c.enter)])] = true;
            is_crossed[at(topology.edge[at(c.leave)])] = true;
        }
    }
    for (const Chain& chain : chains) {
        for (const Crossing& c : chain.crossings) {
            seed(topology.origin[at(c.enter)], 1);
            seed(topology.target(c.enter), -1);
        }
    }
    const auto spread = [&] {
        while (!stack.empty()) {
            const int v = stack.back();
            stack.pop_back();
            for (const int h : outgoing_half_edges(topology, v)) {
                if (!is_crossed[at(topology.edge[at(h)])]) seed(topology.target(h), sign[at(v)]);
                // On the boundary one neighbour has only an incoming half-edge.
                const int last = Topology::previous(h);
                if (!is_crossed[at(topology.edge[at(last)])]) {
                    seed(topology.origin[at(last)], sign[at(v)]);
                }
            }
        }
    };
    spread();
    for (int v = 0; v < topology.vertex_count; ++v) {
        seed(v, height[v] > 0 ? 1 : -1);
        spread();
    }
    Eigen::VectorXd mended = height;
    const double least = 1e-12 * height.cwiseAbs().maxCoeff();
    for (int v = 0; v < topology.vertex_count; ++v) {
        mended[v] = sign[at(v)] * std::max(std::abs(height[v]), least);
    }
    return mended;
}

/// Directions of the segments of a chain, averaged as lines with those before and after.
std::vector<double> smooth_directions(const Topology& topology, const IntrinsicMetric& metric,
                                      const Tracer& tracer, const Chain& chain) {
    const std::size_t count = chain.crossings.size();
    std::vector<Complex> line(count);
    for (std::size_t i = 0; i < count; ++i) {
        const Vector2 d = tracer.segment(chain.crossings[i]);
        const double length = d.norm();
        if (length > 0) line[i] = Complex(d[0], d[1]) * Complex(d[0], d[1]) / length;
    }
    std::vector<Complex> onward(count);  // carries a line into the next triangle
    for (std::size_t i = 0; i < count; ++i) {
        const int h = chain.crossings[i].leave;
        if (topology.twin[at(h)] < 0) continue;
        onward[i] = std::polar(1.0, 2 * frame_rotation(topology, metric, h));
    }
    for (int round = 0; round < 3; ++round) {
        std::vector<Complex> next(count);
        for (std::size_t i = 0; i < count; ++i) {
            next[i] = 2.0 * line[i];
            const std::size_t before = i == 0 ? count - 1 : i - 1;
            const std::size_t after = i + 1 == count ? 0 : i + 1;
            if (i > 0 || chain.is_closed) next[i] += line[before] * onward[before];
            if (i + 1 < count || chain.is_closed) next[i] += line[after] * std::conj(onward[i]);
        }
        line = std::move(next);
    }
    std::vector<double> angle(count);
    for (std::size_t i = 0; i < count; ++i) angle[i] = std::arg(line[i]) / 2;
    return angle;
}

/// Appends the polylines of a chain, cut where it runs through filled holes.
void append_chain(StationaryCurve& curve, const Tracer& tracer, Chain chain,
                  const std::vector<double>& angle, int triangle_count) {
    std::vector<std::size_t> order(chain.crossings.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto is_hole = [&](std::size_t i) {
        return chain.crossings[i].enter / 3 >= triangle_count;
    };
    const auto hole = std::find_if(order.begin(), order.end(), is_hole);
    const bool is_cut = hole != order.end();
    if (chain.is_closed && is_cut) std::rotate(order.begin(), hole, order.end());
    std::vector<SurfacePoint> line;
    const auto end_line = [&](int leave) {
        if (line.empty()) return;
        line.push_back(tracer.point_on(leave));
        curve.polylines.push_back(std::move(line));
        line.clear();
    };
    int last = -1;
    for (const std::size_t i : order) {
        const Crossing& c = chain.crossings[i];
        if (is_hole(i)) {
            end_line(last);
            continue;
        }
        line.push_back(tracer.point_on(c.enter));
        curve.directions.push_back({c.enter / 3, angle[i]});
        last = c.leave;
    }
    if (chain.is_closed && !is_cut) {
        line.push_back(line.front());
        curve.polylines.push_back(std::move(line));
    } else {
        end_line(last);
    }
}

}  // namespace

StationaryCurve trace_stationary_curve(const Topology& topology, const IntrinsicMetric& metric,
                                       const Eigen::VectorXd& height, int triangle_count,
                                       double shortest_share) {
    StationaryCurve curve;
    std::vector<Chain> chains = Tracer(topology, metric, height).trace_all();
    const std::vector<int> part = triangle_components(topology);
    const auto part_of = [&](const Chain& chain) {
        return at(part[at(chain.crossings.front().enter / 3)]);
    };
    std::vector<double> longest(part.size(), 0);
    for (const Chain& chain : chains) {
        double& of_part = longest[part_of(chain)];
        of_part = std::max(of_part, chain.length);
    }
    const std::size_t before = chains.size();
    std::erase_if(chains,
                  [&](const Chain& c) { return c.length < shortest_share * longest[part_of(c)]; });
    curve.dropped_loops = static_cast<int>(before - chains.size());
    curve.height = mend_signs(topology, height, chains);
    const Tracer tracer(topology, metric, curve.height);
    for (const Chain& chain : chains) {
        append_chain(curve, tracer, chain, smooth_directions(topology, metric, tracer, chain),
                     triangle_count);
    }
    return curve;
}

}  // namespace kinequad
