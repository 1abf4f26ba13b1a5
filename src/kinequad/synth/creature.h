#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "kinequad/core/types.h"

namespace kinequad::synth_detail {

/// A bone turns about its joint, whose place is that of the rest pose. Parents come before
/// children.
struct Bone {
    int parent = -1;
    Vector3 joint;
    int mirror = 0;  ///< the bone on the other side, itself in the middle
};

/// A control point of a tube. It follows `bone`, or half of it and half of `other`.
struct TubePoint {
    Vector3 center;
    double radius;
    int bone;
    int other = -1;
};

/// A smooth tube through control points, of the same radius all around in the space that `stretch`
/// maps to; a stretch flattens it.
struct Tube {
    std::vector<TubePoint> points;
    Eigen::Matrix3d stretch = Eigen::Matrix3d::Identity();
};

/// The turn of every bone relative to its parent, about its joint, in the axes of the rest pose.
struct Pose {
    std::vector<Eigen::Quaterniond> rotation;
    Vector3 shift = Vector3::Zero();  ///< of the root
};

/// A point of the body that stands on the ground.
struct Contact {
    int bone;
    Vector3 point;
};

/// A body whose plane of symmetry is x = 0, y up, facing +z, in metres.
struct Creature {
    std::vector<Bone> bones;
    std::vector<Tube> tubes;
    std::vector<Contact> contacts;
    std::vector<Vector3> pair_landmarks;        ///< on the left, x > 0
    std::vector<Vector3> stationary_landmarks;  ///< in the plane
    double blend = 0.012;       ///< width over which tubes melt into one another, metres
    double skin_blend = 0.018;  ///< width over which bones share the skin, metres
    /// Pose at a phase of the cycle in [0, 1).
    std::function<Pose(double phase)> walk;
};

/// Adds parts to a creature, those of the left side together with their mirror images.
class CreatureBuilder {
public:
    int add_bone(int parent, const Vector3& joint);
    /// Returns the left bone; the right one is its `mirror`.
    int add_bone_pair(int parent, const Vector3& joint);
    void add_tube(const Tube& tube);
    void add_tube_pair(const Tube& tube);
    void add_contact_pair(int bone, const Vector3& point);
    Creature creature;
};

/// Stretch by `factor` along `direction`.
Eigen::Matrix3d stretch_along(const Vector3& direction, double factor);

/// Rotation about the x-axis by `degrees`: what points down goes back, what points forward down.
Eigen::Quaterniond turn_x(double degrees);
Eigen::Quaterniond turn_y(double degrees);
Eigen::Quaterniond turn_z(double degrees);
/// The rotation on the other side of the plane x = 0.
Eigen::Quaterniond mirrored(const Eigen::Quaterniond& rotation);

/// Smooth periodic curve through `keys` at equal distances in phase [0, 1).
double cyclic_curve(const std::vector<double>& keys, double phase);

Creature make_biped();
Creature make_quadruped();

}  // namespace kinequad::synth_detail
