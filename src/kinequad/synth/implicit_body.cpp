#include "kinequad/synth/implicit_body.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace kinequad::synth_detail {
namespace {

/// Straight pieces between two control points: enough that their corners do not show.
constexpr int pieces_per_span = 8;
/// Tubes this many blend widths farther than the nearest one no longer count: exp(-14) of a blend
/// width is about 1e-8 metres.
constexpr double far_blends = 14;

/// Catmull-Rom; control points have to be about evenly spaced.
template <class T>
T spline(const T& before, const T& from, const T& to, const T& after, double t) {
    const double t2 = t * t;
    const double t3 = t2 * t;
    return 0.5 * (2 * from + t * (to - before) + t2 * (2 * before - 5 * from + 4 * to - after) +
                  t3 * (3 * from - before - 3 * to + after));
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
    const int index = static_cast<int>(stretch_.size());
    stretch_.push_back(tube.stretch);
    scale_.push_back(1 / tube.stretch.operatorNorm());
    const int spans = static_cast<int>(tube.points.size()) - 1;
    const auto point = [&](int i) -> const TubePoint& {
        return tube.points[static_cast<std::size_t>(std::clamp(i, 0, spans))];
    };
    const auto center_at = [&](int span, double t) -> Vector3 {
        return spline<Vector3>(point(span - 1).center, point(span).center, point(span + 1).center,
                               point(span + 2).center, t);
    };
    const auto radius_at = [&](int span, double t) {
        return spline<double>(point(span - 1).radius, point(span).radius, point(span + 1).radius,
                              point(span + 2).radius, t);
    };
    for (int span = 0; span < spans; ++span) {
        for (int piece = 0; piece < pieces_per_span; ++piece) {
            const double t0 = static_cast<double>(piece) / pieces_per_span;
            const double t1 = static_cast<double>(piece + 1) / pieces_per_span;
            Segment segment;
            segment.tube = index;
            segment.from = tube.stretch * center_at(span, t0);
            segment.along = tube.stretch * center_at(span, t1) - segment.from;
            segment.inverse_squared_length = 1 / segment.along.squaredNorm();
            segment.from_radius = radius_at(span, t0);
            segment.to_radius = radius_at(span, t1);
            segment.from_bones = bones_between(point(span), point(span + 1), t0);
            segment.to_bones = bones_between(point(span), point(span + 1), t1);
            segments_.push_back(std::move(segment));
            const double reach = std::max(radius_at(span, t0), radius_at(span, t1)) + 2 * blend_;
            for (const double t : {t0, t1}) {
                low_ = low_.cwiseMin(center_at(span, t) - Vector3::Constant(reach));
                high_ = high_.cwiseMax(center_at(span, t) + Vector3::Constant(reach));
            }
        }
    }
}

ImplicitBody::Closest ImplicitBody::closest(const Segment& segment, const Vector3& point) const {
    const auto tube = static_cast<std::size_t>(segment.tube);
    const Vector3 offset = stretch_[tube] * point - segment.from;
    const double along =
        std::clamp(offset.dot(segment.along) * segment.inverse_squared_length, 0.0, 1.0);
    const Vector3 across = offset - along * segment.along;
    const double radius = segment.from_radius + along * (segment.to_radius - segment.from_radius);
    return {scale_[tube] * (across.norm() - radius), along, across};
}

ImplicitBody::Selection ImplicitBody::select(const Vector3& center, double radius) const {
    const double reach = 2 * steepness * radius;
    std::vector<double> distance(segments_.size());
    std::vector<double> nearest(stretch_.size(), std::numeric_limits<double>::infinity());
    double nearest_of_all = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < segments_.size(); ++i) {
        distance[i] = closest(segments_[i], center).distance;
        double& of_tube = nearest[static_cast<std::size_t>(segments_[i].tube)];
        of_tube = std::min(of_tube, distance[i]);
        nearest_of_all = std::min(nearest_of_all, distance[i]);
    }
    Selection selection;
    for (std::size_t i = 0; i < segments_.size(); ++i) {
        const double of_tube = nearest[static_cast<std::size_t>(segments_[i].tube)];
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
        const int tube = segments_[static_cast<std::size_t>(selection[i])].tube;
        Closest best{std::numeric_limits<double>::infinity(), 0, Vector3::Zero()};
        const Segment* best_segment = nullptr;
        for (; i < selection.size(); ++i) {
            const Segment& segment = segments_[static_cast<std::size_t>(selection[i])];
            if (segment.tube != tube) break;
            const Closest found = closest(segment, point);
            if (found.distance < best.distance) {
                best = found;
                best_segment = &segment;
            }
        }
        const double length = best.offset.norm();
        Vector3 slope = length > 0 ? Vector3(best.offset / length) : Vector3(Vector3::UnitY());
        if (best.along > 0 && best.along < 1) {
            slope -= (best_segment->to_radius - best_segment->from_radius) *
                     best_segment->inverse_squared_length * best_segment->along;
        }
        slope = scale_[static_cast<std::size_t>(tube)] *
                (stretch_[static_cast<std::size_t>(tube)].transpose() * slope);
        if (best.distance < least) {
            const double shrink = std::exp((best.distance - least) / blend_);
            sum = sum * shrink + 1;
            gradient = gradient * shrink + slope;
            least = best.distance;
        } else {
            const double share = std::exp((least - best.distance) / blend_);
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
            total[static_cast<std::size_t>(entry.bone)].weight +=
                share * (1 - found[i].along) * entry.weight;
        }
        for (const BoneWeight& entry : segments_[i].to_bones) {
            total[static_cast<std::size_t>(entry.bone)].weight +=
                share * found[i].along * entry.weight;
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
        radius = scale_[static_cast<std::size_t>(segment.tube)] *
                 (segment.from_radius + here.along * (segment.to_radius - segment.from_radius));
    }
    return radius;
}

}  // namespace kinequad::synth_detail
