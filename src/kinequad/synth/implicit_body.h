#pragma once

#include <array>
#include <vector>

#include "kinequad/synth/creature.h"

namespace kinequad::synth_detail {

/// Value and gradient of the implicit function of a body: negative inside, near the surface about
/// the distance to it in metres.
struct ImplicitSample {
    double value;
    Vector3 gradient;
};

/// How much of a bone's motion a point follows.
struct BoneWeight {
    int bone = 0;
    double weight = 0;
};
inline constexpr int bones_per_vertex = 4;
/// Weights that sum to one, the largest first.
using BoneWeights = std::array<BoneWeight, bones_per_vertex>;

/// The surface of a creature at rest: the zero level of a smooth union of tubes.
class ImplicitBody {
public:
    explicit ImplicitBody(const Creature& creature);

    /// Indices, ascending, of the segments that matter within `radius` of `center`.
    using Selection = std::vector<int>;
    Selection select(const Vector3& center, double radius) const;
    const Selection& everything() const { return everything_; }

    double value(const Vector3& point, const Selection& selection) const;
    ImplicitSample sample(const Vector3& point, const Selection& selection) const;
    /// The nearby point of the surface, by Newton's method along the gradient; stays in the plane
    /// x = 0 where `in_plane`.
    Vector3 project(Vector3 point, bool in_plane, const Selection& selection) const;
    /// Bones that a point of the surface follows.
    BoneWeights bone_weights(const Vector3& point) const;
    /// Radius of the tube that is nearest, metres.
    double local_radius(const Vector3& point) const;

    /// Bounds of the surface.
    Vector3 low() const { return low_; }
    Vector3 high() const { return high_; }
    /// The function's value changes at most this much over one metre.
    static constexpr double steepness = 1.6;

private:
    /// A straight piece of a tube, in the tube's stretched space.
    struct Segment {
        int tube;
        double place;         ///< where it begins along the axis, in spans
        double place_length;  ///< spans that it covers
        Vector3 from;
        Vector3 along;
        double inverse_squared_length;
        double from_radius, to_radius;
        std::vector<BoneWeight> from_bones, to_bones;
    };
    /// Axis and radius between two control points as cubics of t in [0, 1], in the stretched space.
    struct Span {
        std::array<Vector3, 4> center;
        std::array<double, 4> radius;
    };
    struct Axis {
        Eigen::Matrix3d stretch;
        double scale;  ///< metres a stretched unit
        std::vector<Span> spans;
    };
    struct Closest {
        double distance;
        double along;
    };
    Closest closest(const Segment& segment, const Vector3& point) const;
    /// Distance to a tube and its gradient, from a first guess of the nearest place along its axis.
    ImplicitSample distance_to(const Axis& axis, const Vector3& point, double place) const;
    void add_tube(const Tube& tube);

    double blend_;
    double skin_blend_;
    std::size_t bone_count_;
    std::vector<Axis> axes_;         ///< one a tube
    std::vector<Segment> segments_;  ///< in the order of their tubes
    Selection everything_;
    Vector3 low_, high_;
};

}  // namespace kinequad::synth_detail
