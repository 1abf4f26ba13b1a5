#include "kinequad/gridmap/relax_map.h"

#include <fmt/format.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/solve/minimum_degree_order.h"

namespace kinequad {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

constexpr double barrier = 0.1;
constexpr double least_curvature = 1e-3;
/// Diagonal that keeps a column where it is.
constexpr double pinned = 1e12;

/// `|J - 1|^2 + 2 (turn_weight - 1) (Im a)^2 + 2 (shear_weight - 1) (Im b)^2 + barrier ((|J|^2 + 1)
/// / det + det - 4)` of `f(q) = a q + b conj(q)`, with its first and second derivative, the latter
/// made positive. With the singular values s1 = |a| + |b| and s2 = |a| - |b| the Hessian splits
/// into the radial directions of a and b, which mix, and their tangential directions, which do not.
struct LocalEnergy {
    double value = std::numeric_limits<double>::infinity();
    Complex slope_a, slope_b;  // d value / d a as (d/d Re, d/d Im)
    double radial_aa = 0, radial_ab = 0, radial_bb = 0;
    double tangential_a = 0, tangential_b = 0;
    Complex unit_a, unit_b;
};

double local_value(Complex a, Complex b) {
    const double na = std::norm(a);
    const double nb = std::norm(b);
    const double det = na - nb;
    if (det <= 0) return std::numeric_limits<double>::infinity();
    return 2 * (std::norm(a - 1.0) + nb + (turn_weight - 1) * a.imag() * a.imag() +
                (shear_weight - 1) * b.imag() * b.imag()) +
           barrier * ((2 * (na + nb) + 1) / det + det - 4);
}

LocalEnergy local_energy(Complex a, Complex b) {
    LocalEnergy e;
    e.value = local_value(a, b);
    const double p = std::abs(a);
    const double m = std::abs(b);
    const double s1 = p + m;
    const double s2 = p - m;
    e.unit_a = p > 0 ? a / p : Complex(1, 0);
    e.unit_b = m > 1e-300 ? b / m : Complex(1, 0);
    const double d = s1 * s2;
    const double d1 = barrier * (1 / s2 - s2 / (s1 * s1) + s2 - 1 / (s1 * d));
    const double d2 = barrier * (1 / s1 - s1 / (s2 * s2) + s1 - 1 / (s2 * d));
    const double d11 = barrier * (2 * s2 / (s1 * s1 * s1) + 2 / (s1 * s1 * d));
    const double d22 = barrier * (2 * s1 / (s2 * s2 * s2) + 2 / (s2 * s2 * d));
    const double d12 = barrier * (-1 / (s2 * s2) - 1 / (s1 * s1) + 1 + 1 / (d * d));
    // By s1 = p + m, s2 = p - m.
    const double by_p = d1 + d2;
    const double by_m = d1 - d2;
    e.slope_a = Complex(4 * (a.real() - 1), 4 * turn_weight * a.imag()) + by_p * e.unit_a;
    e.slope_b = Complex(4 * b.real(), 4 * shear_weight * b.imag()) + by_m * e.unit_b;
    double aa = 4 + d11 + 2 * d12 + d22;
    double bb = 4 + d11 - 2 * d12 + d22;
    double ab = d11 - d22;
    // Clamp the eigenvalues of the radial block.
    const double mean = (aa + bb) / 2;
    const double half = (aa - bb) / 2;
    const double spread = std::hypot(half, ab);
    if (mean - spread < least_curvature) {
        const double low = least_curvature;
        const double high = std::max(mean + spread, least_curvature);
        const double c = spread > 0 ? half / spread : 1;
        const double s = spread > 0 ? ab / spread : 0;
        aa = (high + low) / 2 + (high - low) / 2 * c;
        bb = (high + low) / 2 - (high - low) / 2 * c;
        ab = (high - low) / 2 * s;
    }
    e.radial_aa = aa;
    e.radial_ab = ab;
    e.radial_bb = bb;
    e.tangential_a = std::max(least_curvature, 4 + by_p / p);
    // by_m / m without the division by m = (s1 - s2) / 2.
    const double ratio = barrier * (1 / d + (s1 * s1 + d + s2 * s2) / (d * d) - 1 + 1 / (d * d));
    e.tangential_b = std::max(least_curvature, 4 + 2 * ratio);
    return e;
}

class Newton {
public:
    Newton(const MapVariables& variables, TriangleSystem& system,
           const std::vector<TargetShape>& shapes, const Context& context)
        : variables_(variables), system_(system), shapes_(shapes), context_(context) {}

    /// The pull towards `goal` (chain columns); weight 0 pins the chain columns instead.
    void set_pull(double weight, const Eigen::VectorXd& goal) {
        weight_ = weight;
        whole_goal_ = whole_values(goal);
    }

    double energy(const Eigen::VectorXd& x) const {
        const std::vector<Complex> corners = variables_.corner_coordinates(x);
        double sum = 0;
        for (std::size_t t = 0; t < shapes_.size(); ++t) {
            sum += shapes_[t].area * local_value(shapes_[t].conformal_part(&corners[3 * t]),
                                                 shapes_[t].anticonformal_part(&corners[3 * t]));
        }
        return sum + weight_ * (whole_values(chain(x)) - whole_goal_).squaredNorm();
    }

    /// One step from `x`; returns the length taken, 0 where the energy cannot be lowered.
    double step(Eigen::VectorXd& x) {
        context_.check_cancelled();
        const std::vector<Complex> corners = variables_.corner_coordinates(x);
        std::vector<LocalEnergy> local(shapes_.size());
        for (std::size_t t = 0; t < shapes_.size(); ++t) {
            local[t] = local_energy(shapes_[t].conformal_part(&corners[3 * t]),
                                    shapes_[t].anticonformal_part(&corners[3 * t]));
        }
        SparseMatrix hessian = system_.assemble(
            [&](int t) { return hessian_of(shapes_[at(t)], local[at(t)]); }, 2 * weight_);
        Eigen::VectorXd gradient = system_.gather([&](int t) -> Vector6 {
            const TargetShape& shape = shapes_[at(t)];
            const LocalEnergy& e = local[at(t)];
            return shape.area *
                   (shape.functional(e.slope_a, false) + shape.functional(e.slope_b, true));
        });
        if (weight_ > 0) {
            const Eigen::VectorXd away = whole_values(chain(x)) - whole_goal_;
            for (int i = 0; i < variables_.position_count; ++i) {
                for (const auto& [c, f] : variables_.whole[at(i)]) {
                    gradient[variables_.vertex_columns + c] += 2 * weight_ * f * away[i];
                }
            }
            // Translations that no position fixes (handles) are pulled by themselves, gently.
            const Eigen::Index first = variables_.position_count;
            for (int c = 0; c < variables_.chain_columns; ++c) {
                hessian.coeffRef(variables_.vertex_columns + c, variables_.vertex_columns + c) +=
                    2 * weight_;
                gradient[variables_.vertex_columns + c] += 2 * weight_ * away[first + c];
            }
        } else {
            for (int c = variables_.vertex_columns; c < variables_.columns(); ++c) {
                hessian.coeffRef(c, c) += pinned;
                gradient[c] = 0;
            }
        }
        if (!analysed_) {
            factor_.analyzePattern(hessian);
            analysed_ = true;
        }
        factor_.factorize(hessian);
        if (factor_.info() != Eigen::Success) return 0;
        Eigen::VectorXd direction = -factor_.solve(gradient);
        if (weight_ <= 0) direction.tail(variables_.chain_columns).setZero();
        const double slope = gradient.dot(direction);
        if (!(slope < 0)) return 0;
        const double before = energy(x);
        for (double length = std::min(1.0, 0.9 * longest_step(corners, direction)); length > 1e-6;
             length /= 2) {
            const Eigen::VectorXd candidate = x + length * direction;
            if (energy(candidate) <= before + 1e-4 * length * slope) {
                x = candidate;
                return length;
            }
        }
        return 0;
    }

    Eigen::VectorXd chain(const Eigen::VectorXd& x) const {
        return x.tail(variables_.chain_columns);
    }

    /// Triangles whose area vanishes first along the last direction.
    const std::vector<int>& tight() const { return tight_; }

    /// Triangles that the map presses flat: to less than a tenth of their width.
    std::vector<int> crushed(const Eigen::VectorXd& x) const {
        const std::vector<Complex> corners = variables_.corner_coordinates(x);
        std::vector<int> triangles;
        for (std::size_t t = 0; t < shapes_.size(); ++t) {
            if (std::abs(shapes_[t].conformal_part(&corners[3 * t])) -
                    std::abs(shapes_[t].anticonformal_part(&corners[3 * t])) <
                0.1) {
                triangles.push_back(static_cast<int>(t));
            }
        }
        return triangles;
    }

    /// Whether every triangle keeps a positive area all the way from `x` to `end`: its end alone
    /// could hide a cone that has been turned once too often.
    bool can_go_straight(const Eigen::VectorXd& x, const Eigen::VectorXd& end) {
        return longest_step(variables_.corner_coordinates(x), end - x) > 1 &&
               std::isfinite(energy(end));
    }

    /// Positions, then the chain columns themselves.
    Eigen::VectorXd whole_values(const Eigen::VectorXd& chain_values) const {
        Eigen::VectorXd values(variables_.position_count + variables_.chain_columns);
        for (int i = 0; i < variables_.position_count; ++i) {
            values[i] = 0;
            for (const auto& [c, f] : variables_.whole[at(i)]) {
                values[i] += f * chain_values[c];
            }
        }
        values.tail(variables_.chain_columns) = chain_values;
        return values;
    }

private:
    static Matrix6 hessian_of(const TargetShape& shape, const LocalEnergy& e) {
        const Complex i(0, 1);
        const Vector6 ra = shape.functional(e.unit_a, false);
        const Vector6 rb = shape.functional(e.unit_b, true);
        const Vector6 ta = shape.functional(i * e.unit_a, false);
        const Vector6 tb = shape.functional(i * e.unit_b, true);
        Matrix6 h = e.radial_aa * ra * ra.transpose() + e.radial_bb * rb * rb.transpose() +
                    e.tangential_a * ta * ta.transpose() + e.tangential_b * tb * tb.transpose();
        h += e.radial_ab * (ra * rb.transpose() + rb * ra.transpose());
        const Vector6 shear = shape.functional(i, true);
        const Vector6 turn = shape.functional(i, false);
        h += 4 * (shear_weight - 1) * shear * shear.transpose() +
             4 * (turn_weight - 1) * turn * turn.transpose();
        return shape.area * h;
    }

    double longest_step(const std::vector<Complex>& corners, const Eigen::VectorXd& direction) {
        const std::vector<Complex> velocity = variables_.corner_coordinates(direction);
        double longest = std::numeric_limits<double>::infinity();
        std::vector<std::pair<double, int>> roots;
        for (std::size_t t = 0; t < shapes_.size(); ++t) {
            const Complex a0 = corners[3 * t + 1] - corners[3 * t];
            const Complex b0 = corners[3 * t + 2] - corners[3 * t];
            const Complex a1 = velocity[3 * t + 1] - velocity[3 * t];
            const Complex b1 = velocity[3 * t + 2] - velocity[3 * t];
            const auto cross = [](Complex x, Complex y) { return std::imag(std::conj(x) * y); };
            const double c0 = cross(a0, b0);
            const double c1 = cross(a0, b1) + cross(a1, b0);
            const double c2 = cross(a1, b1);
            const double discriminant = c1 * c1 - 4 * c0 * c2;
            if (discriminant < 0) continue;
            const double q = -0.5 * (c1 + std::copysign(std::sqrt(discriminant), c1));
            for (const double root : {c2 != 0 ? q / c2 : -1.0, q != 0 ? c0 / q : -1.0}) {
                if (root <= 0) continue;
                longest = std::min(longest, root);
                if (root < 1) roots.emplace_back(root, static_cast<int>(t));
            }
        }
        std::sort(roots.begin(), roots.end());
        tight_.clear();
        for (std::size_t i = 0; i < roots.size() && roots[i].first < 4 * longest; ++i) {
            tight_.push_back(roots[i].second);
        }
        return longest;
    }

    const MapVariables& variables_;
    TriangleSystem& system_;
    const std::vector<TargetShape>& shapes_;
    const Context& context_;
    double weight_ = 0;
    Eigen::VectorXd whole_goal_;
    bool analysed_ = false;
    std::vector<int> tight_;
    Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, MinimumDegreeOrder> factor_;
};

/// The triangles that hold back a map that stopped at `x`.
std::vector<int> held_back(const Newton& newton, const Eigen::VectorXd& x) {
    std::vector<int> triangles = newton.tight();
    const std::vector<int> crushed = newton.crushed(x);
    triangles.insert(triangles.end(), crushed.begin(), crushed.end());
    return triangles;
}

}  // namespace

Arrival bring_to_integers(const MapVariables& variables, TriangleSystem& system,
                          const std::vector<TargetShape>& shapes, Eigen::VectorXd x,
                          const Eigen::VectorXd& goal, const Context& context) {
    Newton newton(variables, system, shapes, context);
    Arrival arrival;
    double weight = 0.5;
    int stalls = 0;
    // Where the way left no longer shrinks, more steps are of no use.
    constexpr int patience = 7;
    double shortest = std::numeric_limits<double>::infinity();
    int since_shorter = 0;
    for (int i = 0; i < 40 && stalls < 4 && since_shorter < patience; ++i) {
        newton.set_pull(weight, goal);
        const double length = newton.step(x);
        const double away = (newton.chain(x) - goal).cwiseAbs().maxCoeff();
        context.write_log(
            LogLevel::debug,
            fmt::format("gridmap: step {} of length {:.3f}, pull {:.3g}, {:.2e} to go, {} tight", i,
                        length, weight, away, newton.tight().size()));
        Eigen::VectorXd snapped = x;
        snapped.tail(variables.chain_columns) = goal;
        if (newton.can_go_straight(x, snapped)) {
            arrival.x = snapped;
            arrival.arrived = true;
            return arrival;
        }
        ++since_shorter;
        if (away < 0.97 * shortest) {
            shortest = away;
            since_shorter = 0;
        }
        if (length < 0.1) ++stalls;
        if (length > 0.3) weight = std::min(weight * 4, 1e6);
    }
    arrival.x = x;
    arrival.tight = held_back(newton, x);
    return arrival;
}

Arrival follow_path(const MapVariables& variables, TriangleSystem& system,
                    const std::vector<TargetShape>& shapes, Eigen::VectorXd x,
                    const std::vector<Eigen::VectorXd>& path, std::size_t& reached,
                    const Context& context) {
    // Cones are at least about a cell apart: within a part of that there is one way only.
    constexpr double sight = 0.4;
    constexpr double near = 0.15;
    constexpr double first_weight = 8;
    constexpr int patience = 10;
    Newton newton(variables, system, shapes, context);
    Arrival arrival;
    const std::size_t last = path.size() - 1;
    const auto away_from = [&](std::size_t i) {
        return (newton.whole_values(newton.chain(x)) - newton.whole_values(path[i]))
            .cwiseAbs()
            .maxCoeff();
    };
    double weight = first_weight;
    double shortest = std::numeric_limits<double>::infinity();
    std::size_t goal = reached;
    int since_progress = 0;
    for (int i = 0; since_progress < patience; ++i) {
        // What lies before a goal that is passed is passed too.
        for (std::size_t passed = goal; reached < last && passed >= reached; passed = reached) {
            if (away_from(passed) >= near) break;
            reached = std::min(passed + 1, last);
            since_progress = 0;
            if (passed == last) break;
        }
        std::size_t farthest = std::max(goal, reached);
        while (farthest < last && away_from(farthest + 1) < sight) ++farthest;
        if (farthest != goal) {
            goal = farthest;
            shortest = std::numeric_limits<double>::infinity();
            weight = std::max(first_weight, weight / 4);
        }
        newton.set_pull(weight, path[goal]);
        const double length = newton.step(x);
        const double away = away_from(goal);
        context.write_log(LogLevel::debug,
                          fmt::format("gridmap: step {} of length {:.3f}, pull {:.3g}, {:.2e} to "
                                      "go to {} of {} on the path",
                                      i, length, weight, away, goal, last));
        if (goal == last) {
            Eigen::VectorXd snapped = x;
            snapped.tail(variables.chain_columns) = path[last];
            if (newton.can_go_straight(x, snapped)) {
                reached = last;
                arrival.x = snapped;
                arrival.arrived = true;
                return arrival;
            }
        }
        ++since_progress;
        if (away < 0.97 * shortest) {
            shortest = away;
            since_progress = 0;
        }
        if (length > 0.3) weight = std::min(weight * 4, 1e6);
    }
    arrival.x = x;
    arrival.tight = held_back(newton, x);
    return arrival;
}

Eigen::VectorXd relax_map(const MapVariables& variables, TriangleSystem& system,
                          const std::vector<TargetShape>& shapes, Eigen::VectorXd x, int most_steps,
                          const Context& context) {
    Newton newton(variables, system, shapes, context);
    newton.set_pull(0, x.tail(variables.chain_columns));
    double before = newton.energy(x);
    for (int i = 0; i < most_steps; ++i) {
        if (newton.step(x) <= 0) break;
        const double after = newton.energy(x);
        context.write_log(LogLevel::debug, fmt::format("gridmap: relaxed to {:.6g}", after));
        if (before - after < 1e-3 * before) break;
        before = after;
    }
    return x;
}

}  // namespace kinequad
