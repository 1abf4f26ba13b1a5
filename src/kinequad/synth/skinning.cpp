#include "kinequad/synth/skinning.h"

#include <cmath>

#include "kinequad/core/index.h"

namespace kinequad::synth_detail {
namespace {

struct Rigid {
    Eigen::Quaterniond rotation;
    Vector3 translation;
    Vector3 operator()(const Vector3& point) const { return rotation * point + translation; }
};

DualQuaternion dual_of(const Rigid& motion) {
    const Eigen::Quaterniond shift(0, motion.translation.x(), motion.translation.y(),
                                   motion.translation.z());
    return {motion.rotation.coeffs(), 0.5 * (shift * motion.rotation).coeffs()};
}

/// Lowest of the contacts, smoothed over a centimetre so that a change of foot is no jerk.
double ground_height(const Creature& creature, const std::vector<Rigid>& motion) {
    constexpr double softness = 0.01;
    double least = 1e9;
    for (const Contact& contact : creature.contacts) {
        least = std::min(least, motion[at(contact.bone)](contact.point).y());
    }
    double sum = 0;
    for (const Contact& contact : creature.contacts) {
        const double height = motion[at(contact.bone)](contact.point).y();
        sum += std::exp((least - height) / softness);
    }
    return least - softness * std::log(sum);
}

}  // namespace

std::vector<DualQuaternion> bone_motions(const Creature& creature, const Pose& pose) {
    std::vector<Rigid> motion;
    for (std::size_t b = 0; b < creature.bones.size(); ++b) {
        const Bone& bone = creature.bones[b];
        const Rigid local{pose.rotation[b], bone.joint - pose.rotation[b] * bone.joint};
        if (bone.parent < 0) {
            motion.push_back({local.rotation, local.translation + pose.shift});
        } else {
            const Rigid& parent = motion[at(bone.parent)];
            motion.push_back({parent.rotation * local.rotation, parent(local.translation)});
        }
    }
    const double ground = creature.contacts.empty() ? 0 : ground_height(creature, motion);
    std::vector<DualQuaternion> motions;
    for (Rigid& of_bone : motion) {
        of_bone.translation.y() -= ground;
        motions.push_back(dual_of(of_bone));
    }
    return motions;
}

Vector3 skin_point(const Vector3& point, const BoneWeights& weights,
                   const std::vector<DualQuaternion>& motions) {
    const Eigen::Vector4d& first = motions[at(weights[0].bone)].real;
    Eigen::Vector4d real = Eigen::Vector4d::Zero();
    Eigen::Vector4d dual = Eigen::Vector4d::Zero();
    for (const BoneWeight& entry : weights) {
        if (entry.weight == 0) continue;
        const DualQuaternion& motion = motions[at(entry.bone)];
        // The two signs of a quaternion are the same motion; the nearer one is blended.
        const double weight = motion.real.dot(first) < 0 ? -entry.weight : entry.weight;
        real += weight * motion.real;
        dual += weight * motion.dual;
    }
    const double length = real.norm();
    real /= length;
    dual /= length;
    const Vector3 r = real.head<3>();
    const Vector3 d = dual.head<3>();
    const Vector3 rotated = point + 2 * r.cross(r.cross(point) + real.w() * point);
    return rotated + 2 * (real.w() * d - dual.w() * r + r.cross(d));
}

}  // namespace kinequad::synth_detail
