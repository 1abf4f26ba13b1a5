#include "kinequad/gridmap/quantize.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"

namespace kinequad {
namespace {

/// Twice the area every triangle of cones should keep, in cells; whole triangles have at least 1.
constexpr double wanted_room = 1.3;
/// Length every edge between cones should keep, in cells; whole ones have at least 1.
constexpr double wanted_distance = 1.2;
/// What is asked of loops above the cells that quads need around them.
constexpr double loop_slack = 0.2;
/// Share by which the count may be missed where cones leave little choice.
constexpr double rough = 0.045;
/// How often rounding may get stuck before a scale is given up.
constexpr int most_attempts = 6;

class Rounding {
public:
    Rounding(ConeTriangulation cone, const Eigen::MatrixXd& stiffness, Eigen::VectorXd best,
             const WantedQuads& wanted, double room_weight, const Context& context)
        : cone_(std::move(cone)),
          stiffness_(stiffness),
          best_(std::move(best)),
          wanted_(wanted),
          room_weight_(room_weight),
          context_(context),
          is_fixed_(static_cast<std::size_t>(best_.size()), 0),
          path_(1, cone_.integers()) {}

    /// Whole numbers for all unknowns, or nothing where cones block each other.
    std::optional<Eigen::VectorXd> run() {
        make_room(60);
        if (!round_all()) return std::nullopt;
        improve();
        return cone_.integers();
    }

    double quads() const { return cone_.area(); }
    std::vector<Eigen::VectorXd> take_path() { return std::move(path_); }

private:
    /// Moves the cones, and notes where to.
    bool move(const Eigen::VectorXd& step) {
        if (!cone_.move(step)) return false;
        const Eigen::VectorXd& here = cone_.integers();
        const std::size_t count = path_.size();
        // A step that is taken back leaves no trace.
        if (count > 1 && (path_[count - 2] - here).cwiseAbs().maxCoeff() < 1e-9) {
            path_.pop_back();
        } else {
            path_.push_back(here);
        }
        return true;
    }

    double energy() const {
        const Eigen::VectorXd away = cone_.integers() - best_;
        double sum = away.dot(stiffness_ * away);
        for (int i = 0; i < cone_.triangle_count(); ++i) {
            const double lack = wanted_room - cone_.determinant(i);
            if (lack > 0) sum += room_weight_ * lack * lack;
        }
        for (const int h : cone_.edges()) {
            const double lack = wanted_length(h) - cone_.edge_length(h);
            if (lack > 0) sum += room_weight_ * lack * lack;
        }
        // A long triangle has area even where its apex is next to a line that it must not reach.
        for (const int h : cone_.overlooked_lines()) {
            const double lack = wanted_distance - cone_.height(h);
            if (lack > 0) sum += room_weight_ * lack * lack;
        }
        return sum;
    }

    std::vector<int> free_unknowns() const {
        std::vector<int> free;
        for (int i = 0; i < best_.size(); ++i) {
            if (!is_fixed_[at(i)]) free.push_back(i);
        }
        return free;
    }

    /// Length the edge of a half-edge should keep. Around a limb or a hole there have to be cells
    /// enough for a quad mesh: no two edges between the same two vertices, an even number on the
    /// boundary.
    double wanted_length(int h) const {
        const int boundary = cone_.boundary_loop_size(h);
        if (boundary > 0 && boundary < 3) return 4.0 / boundary + loop_slack;
        return cone_.is_loop(h) ? 3 + loop_slack : wanted_distance;
    }

    /// Adds the square of `lack - gradient * step` to the normal equations over the unknowns that
    /// have a `place`.
    void add_residual(double lack, const LinearForm<double>& gradient,
                      const std::vector<int>& place, Eigen::MatrixXd& matrix,
                      Eigen::VectorXd& right) const {
        // Most unknowns are fixed for most of the time.
        LinearForm<double> moving;
        for (const auto& [i, gi] : gradient) {
            const int row = place[at(i)];
            if (row >= 0) moving.emplace_back(row, gi);
        }
        for (const auto& [row, gi] : moving) {
            right[row] += room_weight_ * lack * gi;
            for (const auto& [column, gj] : moving) {
                if (column <= row) matrix(row, column) += room_weight_ * gi * gj;
            }
        }
    }

    /// Gauss-Newton steps on `energy` over the unknowns that are not fixed.
    void make_room(int most_steps) {
        const std::vector<int> free = free_unknowns();
        if (free.empty()) return;
        std::vector<int> place(is_fixed_.size(), -1);
        for (std::size_t i = 0; i < free.size(); ++i) place[at(free[i])] = static_cast<int>(i);
        double before = energy();
        for (int i = 0; i < most_steps; ++i) {
            context_.check_cancelled();
            Eigen::MatrixXd matrix = stiffness_(free, free);
            Eigen::VectorXd right = (stiffness_ * (best_ - cone_.integers()))(free);
            for (int t = 0; t < cone_.triangle_count(); ++t) {
                const double lack = wanted_room - cone_.determinant(t);
                if (lack > 0)
                    add_residual(lack, cone_.determinant_gradient(t), place, matrix, right);
            }
            for (const int h : cone_.edges()) {
                const double lack = wanted_length(h) - cone_.edge_length(h);
                if (lack > 0)
                    add_residual(lack, cone_.edge_length_gradient(h), place, matrix, right);
            }
            for (const int h : cone_.overlooked_lines()) {
                const double lack = wanted_distance - cone_.height(h);
                if (lack > 0) add_residual(lack, cone_.height_gradient(h), place, matrix, right);
            }
            const Eigen::VectorXd direction =
                matrix.selfadjointView<Eigen::Lower>().llt().solve(right);
            bool moved = false;
            for (double length = 1; length > 0.05; length /= 2) {
                Eigen::VectorXd step = Eigen::VectorXd::Zero(best_.size());
                step(free) = length * direction;
                if (!move(step)) continue;
                const double after = energy();
                if (after < before) {
                    moved = before - after > 1e-4 * before;
                    before = after;
                    break;
                }
                // Where the way back is blocked the step stays.
                if (!move(-step)) {
                    before = after;
                    break;
                }
            }
            if (!moved) return;
        }
    }

    bool round_all() {
        Eigen::MatrixXd compliance = free_compliance();
        std::vector<char> deferred(is_fixed_.size(), 0);
        int since_room = 0;
        int attempt = 0;
        while (true) {
            context_.check_cancelled();
            const int i = easiest(compliance, deferred);
            if (i < 0) {
                if (free_unknowns().empty()) return true;
                // All that is left is blocked: make room anew, from the second time on with those
                // around it, the farther the more often, and try again.
                if (++attempt > most_attempts) return false;
                release_around(attempt / 2);
                std::fill(deferred.begin(), deferred.end(), 0);
                make_room(30);
                compliance = free_compliance();
                continue;
            }
            if (!fix(i, compliance)) {
                deferred[at(i)] = 1;
                continue;
            }
            const Eigen::VectorXd column = compliance.col(i) / std::sqrt(compliance(i, i));
            compliance.noalias() -= column * column.transpose();
            is_fixed_[at(i)] = 1;
            if (++since_room == 10) {
                since_room = 0;
                make_room(3);
                std::fill(deferred.begin(), deferred.end(), 0);
            }
        }
    }

    /// How the unknowns that are not fixed give way, zero for the others.
    Eigen::MatrixXd free_compliance() const {
        const std::vector<int> free = free_unknowns();
        const auto count = static_cast<Eigen::Index>(free.size());
        Eigen::MatrixXd compliance = Eigen::MatrixXd::Zero(best_.size(), best_.size());
        const Eigen::MatrixXd block = stiffness_(free, free);
        const Eigen::MatrixXd inverse = block.llt().solve(Eigen::MatrixXd::Identity(count, count));
        compliance(free, free) = inverse;
        return compliance;
    }

    /// Frees the fixed unknowns that share a triangle of cones with a free one, `rings` times over.
    void release_around(int rings) {
        for (int ring = 0; ring < rings; ++ring) {
            std::vector<char> is_fixed = is_fixed_;
            for (int t = 0; t < cone_.triangle_count(); ++t) {
                const LinearForm<double> form = cone_.determinant_gradient(t);
                const bool is_near = std::any_of(form.begin(), form.end(), [&](const auto& term) {
                    return is_fixed_[at(term.first)] == 0;
                });
                if (!is_near) continue;
                for (const auto& term : form) is_fixed[at(term.first)] = 0;
            }
            is_fixed_ = std::move(is_fixed);
        }
    }

    int easiest(const Eigen::MatrixXd& compliance, const std::vector<char>& deferred) const {
        int best = -1;
        double least = std::numeric_limits<double>::infinity();
        for (int i = 0; i < best_.size(); ++i) {
            if (is_fixed_[at(i)] || deferred[at(i)]) continue;
            const double value = cone_.integers()[i];
            const double delta = std::round(value) - value;
            const double cost = delta * delta / compliance(i, i);
            if (cost < least) {
                least = cost;
                best = i;
            }
        }
        return best;
    }

    /// Moves unknown `i` to a whole number, the others after it as far as cones allow.
    bool fix(int i, const Eigen::MatrixXd& compliance) {
        const double value = cone_.integers()[i];
        const double nearest = std::round(value);
        const double other = nearest > value ? nearest - 1 : nearest + 1;
        const double beyond = nearest > value ? nearest + 1 : nearest - 1;
        for (const double whole : {nearest, other, beyond}) {
            for (const double follow : {1.0, 0.5, 0.0}) {
                Eigen::VectorXd step =
                    compliance.col(i) * (follow * (whole - value) / compliance(i, i));
                for (int j = 0; j < step.size(); ++j) {
                    if (is_fixed_[at(j)]) step[j] = 0;
                }
                step[i] = whole - value;
                if (!move(step)) continue;
                Eigen::VectorXd exact = cone_.integers();
                exact[i] = whole;
                cone_.snap(exact);
                return true;
            }
        }
        return false;
    }

    /// Whole steps, one or two at once, while they lower the energy.
    void improve() {
        const Eigen::MatrixXd steps = whole_steps();
        const Eigen::MatrixXd pushed = stiffness_ * steps;
        const Eigen::MatrixXd bend = steps.transpose() * pushed;
        double least = energy();
        const auto most_rounds = 40 * best_.size() + 10;
        for (Eigen::Index round = 0; round < most_rounds; ++round) {
            const double before = least;
            const Eigen::VectorXd slope = 2 * (pushed.transpose() * (cone_.integers() - best_));
            for (const WholeStep& step : promising_steps(slope, bend)) {
                Eigen::VectorXd way = step.first_sign * steps.col(step.first);
                if (step.second >= 0) way += step.second_sign * steps.col(step.second);
                least = take_if_better(way, before);
                if (least < before) break;
            }
            if (!(least < before)) return;
        }
    }

    /// A step, or two, and what it changes the energy without room by.
    struct WholeStep {
        double change;
        int first;
        int first_sign;
        int second = -1;  ///< none
        int second_sign = 0;

        auto order() const { return std::tie(change, first, first_sign, second, second_sign); }
    };

    /// The steps that should gain most, best first. The energy changes with step i by `slope_i +
    /// bend_ii`, and by `2 bend_ij` more where j comes with it.
    static std::vector<WholeStep> promising_steps(const Eigen::VectorXd& slope,
                                                  const Eigen::MatrixXd& bend) {
        constexpr std::size_t most_steps = 200;
        constexpr Eigen::Index most_in_pairs = 1000;
        constexpr double least_gain = 1e-9;
        const auto count = static_cast<int>(slope.size());
        std::vector<WholeStep> steps;
        for (int i = 0; i < count; ++i) {
            for (const int sign : {1, -1}) {
                const double alone = sign * slope[i] + bend(i, i);
                if (alone < -least_gain) steps.push_back({alone, i, sign});
                if (count > most_in_pairs) continue;
                for (int j = 0; j < i; ++j) {
                    for (const int other : {1, -1}) {
                        const double both =
                            alone + other * slope[j] + bend(j, j) + 2 * sign * other * bend(j, i);
                        if (both < -least_gain) steps.push_back({both, i, sign, j, other});
                    }
                }
            }
        }
        const auto kept = static_cast<std::ptrdiff_t>(std::min(most_steps, steps.size()));
        std::partial_sort(steps.begin(), steps.begin() + kept, steps.end(),
                          [](const auto& a, const auto& b) { return a.order() < b.order(); });
        steps.resize(static_cast<std::size_t>(kept));
        return steps;
    }

    /// Takes a step that cones allow, and takes it back where the energy does not fall below
    /// `before`, a loop gets too short for quads or the count gets too far off. Returns the energy.
    double take_if_better(const Eigen::VectorXd& step, double before) {
        context_.check_cancelled();
        const int short_before = count_short_loops();
        const double most_missed = std::max({wanted_.tolerance, rough * wanted_.count, missed()});
        if (!move(step)) return before;
        const double after = energy();
        const bool is_better =
            after < before && count_short_loops() <= short_before && missed() <= most_missed + 1e-6;
        // Where the way back is blocked the step stays.
        const bool stays = is_better || !move(-step);
        snap_to_whole();
        return stays ? after : before;
    }

    /// Quads too many or too few.
    double missed() const { return std::abs(cone_.area() - wanted_.count); }

    /// Edges around a limb or a hole that are too short for a quad mesh.
    int count_short_loops() const {
        constexpr double tolerance = 1e-6;
        int count = 0;
        for (const int h : cone_.edges()) {
            const double wanted = wanted_length(h);
            if (wanted > wanted_distance && cone_.edge_length(h) < wanted - loop_slack - tolerance)
                ++count;
        }
        return count;
    }

    /// One unknown by 1 a column; then, where they are not too many, the same with the others
    /// following by whole numbers as far as they give way.
    Eigen::MatrixXd whole_steps() const {
        constexpr Eigen::Index most_followed = 500;
        const Eigen::Index count = best_.size();
        if (count > most_followed) return Eigen::MatrixXd::Identity(count, count);
        const Eigen::MatrixXd compliance =
            stiffness_.llt().solve(Eigen::MatrixXd::Identity(count, count));
        Eigen::MatrixXd steps(count, 2 * count);
        steps.leftCols(count).setIdentity();
        for (Eigen::Index i = 0; i < count; ++i) {
            steps.col(count + i) = (compliance.col(i) / compliance(i, i)).array().round();
        }
        return steps;
    }

    void snap_to_whole() { cone_.snap(cone_.integers().array().round()); }

    ConeTriangulation cone_;
    const Eigen::MatrixXd& stiffness_;
    Eigen::VectorXd best_;
    WantedQuads wanted_;
    double room_weight_;  ///< of the squares of lacking room against the energy
    const Context& context_;
    std::vector<char> is_fixed_;
    std::vector<Eigen::VectorXd> path_;
};

}  // namespace

std::optional<Quantization> quantize(const ConeTriangulation& cone,
                                     const Eigen::MatrixXd& stiffness, const Eigen::VectorXd& best,
                                     const WantedQuads& wanted, const Context& context) {
    // Scales are tried around the one that should give the wanted count; where cones block each
    // other at one, a slightly different one often works, or room that counts more against shape.
    struct Detour {
        double scale;
        double room_weight;
    };
    constexpr std::array<Detour, 8> detours = {
        {{1, 10}, {1.01, 10}, {0.99, 10}, {1, 40}, {1.02, 40}, {0.98, 40}, {1, 150}, {1.1, 150}}};
    // Rounding takes about the cube of the number of unknowns: with many there are fewer attempts.
    const int most = std::clamp(3000 / std::max(1, static_cast<int>(best.size())), 8, 40);
    double centre = std::sqrt(wanted.count / cone.area());
    std::size_t blocked = 0;
    std::optional<Quantization> closest;
    const auto miss = [&](const Quantization& q) { return std::abs(q.quads - wanted.count); };
    // The longer it takes, the more is fair.
    const auto fair = [&](int attempt) {
        return std::max(wanted.tolerance, (attempt < 1   ? 0.02
                                           : attempt < 3 ? 0.03
                                                         : 0.045) *
                                              wanted.count);
    };
    int halvings = 0;
    for (int attempt = 0; attempt < most; ++attempt) {
        if (blocked == detours.size()) {
            // Half way back to the scale that worked, where it is far off.
            constexpr int most_halvings = 3;
            if (!closest || miss(*closest) <= rough * wanted.count || halvings++ == most_halvings)
                break;
            centre = std::sqrt(centre * closest->scale);
            blocked = 0;
        }
        // Once there is a result that will do, far detours cannot bring a closer one.
        const bool will_do = closest && miss(*closest) <= rough * wanted.count;
        if (will_do && (blocked > 2 || detours[blocked].scale > 1.05)) break;
        const double scale = centre * detours[blocked].scale;
        ConeTriangulation scaled = cone;
        scaled.scale(scale);
        Rounding rounding(std::move(scaled), stiffness, scale * best, wanted,
                          detours[blocked].room_weight, context);
        const std::optional<Eigen::VectorXd> integers = rounding.run();
        if (!integers) {
            context.write_log(
                LogLevel::info,
                fmt::format("gridmap: cones block each other at scale {:.3f}", scale));
            ++blocked;
            if (closest && miss(*closest) <= fair(attempt)) break;
            continue;
        }
        Quantization found{*integers, scale, rounding.quads(), rounding.take_path()};
        const double quads = found.quads;
        const bool is_closer = !closest || miss(found) < miss(*closest);
        if (is_closer) closest = std::move(found);
        if (miss(*closest) <= fair(attempt)) break;
        if (is_closer) {
            centre = scale * std::sqrt(wanted.count / quads);
            blocked = 0;
        } else {
            ++blocked;
        }
    }
    return closest;
}

}  // namespace kinequad
