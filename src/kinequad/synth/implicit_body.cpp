#include "kinequad/synth/implicit_body.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kinequad/core/index.h"

namespace kinequad::synth_detail {
namespace {

/// Straight pieces between two control points, from which the place along the smooth axis is
/// refined.
constexpr int pieces_per_span = 4;
/// Tubes this many blend widths farther than the nearest one no longer count: exp(-14) of a blend
/// width is about 1e-8 metres.
constexpr double far_blends = 14;

/// Coefficients of the cubic from `from` to `to` with Catmull-Rom's slopes; control points have to
/// be about evenly spaced.
template <class T>
std::array<T, 4> cubic_between(const T& before, const T& from, const T& to, const T& after) {
    return {from, 0.5 * (to - before), 0.5 * (2 * before - 5 * from + 4 * to - after),
            0.5 * (3 * from - before - 3 * to + after)};
}

template <class T>
T value_of(const std::array<T, 4>& cubic, double t) {
    return cubic[0] + t * (cubic[1] + t * (cubic[2] + t * cubic[3]));
}
template <class T>
T slope_of(const std::array<T, 4>& cubic, double t) {
    return cubic[1] + t * (2 * cubic[2] + 3 * t * cubic[3]);
}
template <class T>
T bend_of(const std::array<T, 4>& cubic, double t) {
    return 2 * cubic[2] + 6 * t * cubic[3];
}

std::vector<BoneWeight> bones_between(const TubePoint& from, const TubePoint& to, double t) {
    const double s = t * t * (3 - 2 * t);
    std::vector<BoneWeight> bones;
    const auto add = [&](int bone, double weight) {
        if (weight <= 0) return;
        for (BoneWeight& entry : bones) {
            if (entry.bone == bone) {
                entry.weight += weight;
                return;
            }
        }
        bones.push_back({bone, weight});
    };
    const auto add_point = [&](const TubePoint& point, double weight) {
        const bool shared = point.other >= 0;
        add(point.bone, shared ? 0.5 * weight : weight);
        if (shared) add(point.other, 0.5 * weight);
    };
    add_point(from, 1 - s);
    add_point(to, s);
    return bones;
}

}  // namespace

ImplicitBody::ImplicitBody(const Creature& creature)
    : blend_(creature.blend),
      skin_blend_(creature.skin_blend),
      bone_count_(creature.bones.size()),
      low_(Vector3::Constant(std::numeric_limits<double>::infinity())),
      high_(-low_) {
    for (const Tube& tube : creature.tubes) add_tube(tube);
    for (std::size_t i = 0; i < segments_.size(); ++i) everything_.push_back(static_cast<int>(i));
}

void ImplicitBody::add_tube(const Tube& tube) {
    const int index = static_cast<int>(axes_.size());
    Axis axis{tube.stretch, 1 / tube.stretch.operatorNorm(), {}};
    const int last = static_cast<int>(tube.points.size()) - 1;
    const auto point = [&](int i) -> const TubePoint& {
        return tube.points[at(std::clamp(i, 0, last))];
    };
    const auto radius = [&](int i) { return point(i).radius; };
    for (int span = 0; span < last; ++span) {
        Span made;
        made.center = cubic_between<Vector3>(
            tube.stretch * point(span - 1).center, tube.stretch * point(span).center,
            tube.stretch * point(span + 1).center, tube.stretch * point(span + 2).center);
        made.radius = cubic_between<double>(radius(span - 1), radius(span), radius(span + 1),
                                            radius(span + 2));
        axis.spans.push_back(made);
        for (int piece = 0; piece < pieces_per_span; ++piece) {
            const double t0 = static_cast<double>(piece) / pieces_per_span;
            const double t1 = static_cast<double>(piece + 1) / pieces_per_span;
            Segment segment;
            segment.tube = index;
            segment.place = span + t0;
            segment.place_length = t1 - t0;
            segment.from = value_of(made.center, t0);
            segment.along = value_of(made.center, t1) - segment.from;
            segment.inverse_squared_length = 1 / segment.along.squaredNorm();
            segment.from_radius = value_of(made.radius, t0);
            segment.to_radius = value_of(made.radius, t1);
            segment.from_bones = bones_between(point(span), point(span + 1), t0);
            segment.to_bones = bones_between(point(span), point(span + 1), t1);
            segments_.push_back(std::move(segment));
        }
        const double reach = std::max(radius(span), radius(span + 1)) + 3 * blend_;
        for (const int end : {span, span + 1}) {
            low_ = low_.cwiseMin(point(end).center - Vector3::Constant(reach));
            high_ = high_.cwiseMax(point(end).center + Vector3::Constant(reach));
        }
    }
    axes_.push_back(std::move(axis));
}

ImplicitBody::Closest ImplicitBody::closest(const Segment& segment, const Vector3& point) const {
    const Axis& axis = axes_[at(segment.tube)];
    const Vector3 offset = axis.stretch * point - segment.from;
    const double along =
        std::clamp(offset.dot(segment.along) * segment.inverse_squared_length, 0.0, 1.0);
    const Vector3 across = offset - along * segment.along;
    const double radius = segment.from_radius + along * (segment.to_radius - segment.from_radius);
    return {axis.scale * (across.norm() - radius), along};
}

ImplicitSample ImplicitBody::distance_to(const Axis& axis, const Vector3& point,
                                         double place) const {
    const Vector3 target = axis.stretch * point;
    const auto last = static_cast<double>(axis.spans.size());
    const auto split = [&](double place) {
        const double span = std::min(std::floor(place), last - 1);
        return std::pair(static_cast<std::size_t>(span), place - span);
    };
    // The tube is the envelope of the spheres along its axis, which is smooth also where round caps
    // begin. Newton's method for the sphere whose surface is nearest, guarded to descend.
    for (int step = 0; step < 5; ++step) {
        const auto [span, t] = split(place);
        const Span& at = axis.spans[span];
        const Vector3 offset = target - value_of(at.center, t);
        const double length = std::max(offset.norm(), 1e-6);
        const Vector3 tangent = slope_of(at.center, t);
        const double along = offset.dot(tangent) / length;
        const double slope = -along - slope_of(at.radius, t);
        const double least = 0.2 * tangent.squaredNorm() / length;
        const double bend =
            (tangent.squaredNorm() - along * along - offset.dot(bend_of(at.center, t))) / length -
            bend_of(at.radius, t);
        const double change = std::clamp(-slope / std::max(bend, least), -0.4, 0.4);
        place = std::clamp(place + change, 0.0, last);
        if (std::abs(change) < 1e-9) break;
    }
    const auto [span, t] = split(place);
    const Vector3 offset = target - value_of(axis.spans[span].center, t);
    const double length = offset.norm();
    const Vector3 normal = length > 0 ? Vector3(offset / length) : Vector3(Vector3::UnitY());
    return {axis.scale * (length - value_of(axis.spans[span].radius, t)),
            axis.scale * (axis.stretch.transpose() * normal)};
}

ImplicitBody::Selection ImplicitBody::select(const Vector3& center, double radius) const {
    const double reach = 2 * steepness * radius;
    std::vector<double> distance(segments_.size());
    std::vector<double> nearest(axes_.size(), std::numeric_limits<double>::infinity());
    double nearest_of_all = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < segments_.size(); ++i) {
        distance[i] = closest(segments_[i], center).distance;
        double& of_tube = nearest[at(segments_[i].tube)];
        of_tube = std::min(of_tube, distance[i]);
        nearest_of_all = std::min(nearest_of_all, distance[i]);
    }
    Selection selection;
    for (std::size_t i = 0; i < segments_.size(); ++i) {
        const double of_tube = nearest[at(segments_[i].tube)];
        if (distance[i] <= of_tube + reach &&
            of_tube <= nearest_of_all + reach + far_blends * blend_) {
            selection.push_back(static_cast<int>(i));
        }
    }
    return selection;
}

double ImplicitBody::value(const Vector3& point, const Selection& selection) const {
    return sample(point, selection).value;
}

ImplicitSample ImplicitBody::sample(const Vector3& point, const Selection& selection) const {
    // A running, shifted sum of exp(-distance / blend) over the tubes.
    double least = std::numeric_limits<double>::infinity();
    double sum = 0;
    Vector3 gradient = Vector3::Zero();
    for (std::size_t i = 0; i < selection.size();) {
        const int tube = segments_[at(selection[i])].tube;
        double nearest = std::numeric_limits<double>::infinity();
        double place = 0;
        for (; i < selection.size(); ++i) {
            const Segment& segment = segments_[at(selection[i])];
            if (segment.tube != tube) break;
            const Closest found = closest(segment, point);
            if (found.distance < nearest) {
                nearest = found.distance;
                place = segment.place + found.along * segment.place_length;
            }
        }
        // A tube too far to count is not worth the exact distance.
        if (nearest - 0.01 > least + far_blends * blend_) continue;
        const auto [distance, slope] = distance_to(axes_[at(tube)], point, place);
        if (distance < least) {
            const double shrink = std::exp((distance - least) / blend_);
            sum = sum * shrink + 1;
            gradient = gradient * shrink + slope;
            least = distance;
        } else {
            const double share = std::exp((least - distance) / blend_);
            sum += share;
            gradient += share * slope;
        }
    }
    return {least - blend_ * std::log(sum), gradient / sum};
}

Vector3 ImplicitBody::project(Vector3 point, bool in_plane, const Selection& selection) const {
    for (int step = 0; step < 4; ++step) {
        ImplicitSample here = sample(point, selection);
        if (in_plane) here.gradient.x() = 0;
        const double squared = std::max(here.gradient.squaredNorm(), 0.04);
        point -= here.value / squared * here.gradient;
        if (std::abs(here.value) < 1e-7) break;
    }
    return point;
}

BoneWeights ImplicitBody::bone_weights(const Vector3& point) const {
    std::vector<Closest> found(segments_.size());
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < segments_.size(); ++i) {
        found[i] = closest(segments_[i], point);
        least = std::min(least, found[i].distance);
    }
    std::vector<BoneWeight> total(bone_count_);
    for (std::size_t b = 0; b < bone_count_; ++b) total[b].bone = static_cast<int>(b);
    for (std::size_t i = 0; i < segments_.size(); ++i) {
        const double share = std::exp((least - found[i].distance) / skin_blend_);
        if (share < 1e-5) continue;
        for (const BoneWeight& entry : segments_[i].from_bones) {
            total[at(entry.bone)].weight += share * (1 - found[i].along) * entry.weight;
        }
        for (const BoneWeight& entry : segments_[i].to_bones) {
            total[at(entry.bone)].weight += share * found[i].along * entry.weight;
        }
    }
    std::stable_sort(total.begin(), total.end(),
                     [](const auto& a, const auto& b) { return a.weight > b.weight; });
    // Taking the first dropped weight off all lets a bone enter and leave without a step.
    const double cut = total.size() > bones_per_vertex ? total[bones_per_vertex].weight : 0;
    BoneWeights weights{};
    double sum = 0;
    for (std::size_t k = 0; k < std::min<std::size_t>(bones_per_vertex, total.size()); ++k) {
        weights[k] = {total[k].bone, total[k].weight - cut};
        sum += weights[k].weight;
    }
    for (BoneWeight& entry : weights) entry.weight /= sum;
    return weights;
}

double ImplicitBody::local_radius(const Vector3& point) const {
    double least = std::numeric_limits<double>::infinity();
    double radius = 0;
    for (const Segment& segment : segments_) {
        const Closest here = closest(segment, point);
        if (here.distance >= least) continue;
        least = here.distance;
        radius = axes_[at(segment.tube)].scale *
                 (segment.from_radius + here.along * (segment.to_radius - segment.from_radius));
    }
    return radius;
}

}  // namespace kinequad::synth_detail
