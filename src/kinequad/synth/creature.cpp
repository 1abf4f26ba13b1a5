#include "kinequad/synth/creature.h"

#include <cmath>
#include <numbers>

#include "kinequad/core/index.h"

namespace kinequad::synth_detail {
namespace {

constexpr double radians = std::numbers::pi / 180;

Vector3 reflect(const Vector3& v) { return {-v.x(), v.y(), v.z()}; }

Eigen::Quaterniond turn(double degrees, const Vector3& axis) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(degrees * radians, axis));
}

}  // namespace

int CreatureBuilder::add_bone(int parent, const Vector3& joint) {
    const int index = static_cast<int>(creature.bones.size());
    creature.bones.push_back({parent, joint, index});
    return index;
}

int CreatureBuilder::add_bone_pair(int parent, const Vector3& joint) {
    const int left = static_cast<int>(creature.bones.size());
    const int other_parent = creature.bones[at(parent)].mirror;
    creature.bones.push_back({parent, joint, left + 1});
    creature.bones.push_back({other_parent, reflect(joint), left});
    return left;
}

void CreatureBuilder::add_tube(const Tube& tube) { creature.tubes.push_back(tube); }

void CreatureBuilder::add_tube_pair(const Tube& tube) {
    creature.tubes.push_back(tube);
    Tube other = tube;
    const Eigen::Matrix3d flip = Vector3(-1, 1, 1).asDiagonal();
    other.stretch = flip * tube.stretch * flip;
    for (TubePoint& point : other.points) {
        point.center = reflect(point.center);
        point.bone = creature.bones[at(point.bone)].mirror;
        if (point.other >= 0) {
            point.other = creature.bones[at(point.other)].mirror;
        }
    }
    creature.tubes.push_back(other);
}

void CreatureBuilder::add_contact_pair(int bone, const Vector3& point) {
    creature.contacts.push_back({bone, point});
    creature.contacts.push_back({creature.bones[at(bone)].mirror, reflect(point)});
}

Eigen::Matrix3d stretch_along(const Vector3& direction, double factor) {
    const Vector3 d = direction.normalized();
    return Eigen::Matrix3d::Identity() + (factor - 1) * d * d.transpose();
}

Eigen::Quaterniond turn_x(double degrees) { return turn(degrees, Vector3::UnitX()); }
Eigen::Quaterniond turn_y(double degrees) { return turn(degrees, Vector3::UnitY()); }
Eigen::Quaterniond turn_z(double degrees) { return turn(degrees, Vector3::UnitZ()); }

Eigen::Quaterniond mirrored(const Eigen::Quaterniond& rotation) {
    return {rotation.w(), rotation.x(), -rotation.y(), -rotation.z()};
}

double cyclic_curve(const std::vector<double>& keys, double phase) {
    const auto count = static_cast<int>(keys.size());
    const double place = (phase - std::floor(phase)) * count;
    const int first = static_cast<int>(place);
    const double t = place - first;
    const auto key = [&](int i) { return keys[at(((first + i) % count + count) % count)]; };
    const double from_slope = 0.5 * (key(1) - key(-1));
    const double to_slope = 0.5 * (key(2) - key(0));
    const double t2 = t * t;
    const double t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * key(0) + (t3 - 2 * t2 + t) * from_slope +
           (3 * t2 - 2 * t3) * key(1) + (t3 - t2) * to_slope;
}

}  // namespace kinequad::synth_detail
