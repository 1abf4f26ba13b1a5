#pragma once

#include <vector>

#include "kinequad/synth/creature.h"
#include "kinequad/synth/implicit_body.h"

namespace kinequad::synth_detail {

/// A rigid motion as a unit dual quaternion.
struct DualQuaternion {
    Eigen::Vector4d real;  ///< x, y, z, w
    Eigen::Vector4d dual;
};

/// Motion of every bone from the rest pose to `pose`, moved up or down so that the lowest foot
/// stands on the ground.
std::vector<DualQuaternion> bone_motions(const Creature& creature, const Pose& pose);

/// Place of a rest point that follows bones by `weights`: blended dual quaternions
/// [Kavan 2008], which keep the volume where linear blending loses it.
Vector3 skin_point(const Vector3& point, const BoneWeights& weights,
                   const std::vector<DualQuaternion>& motions);

}  // namespace kinequad::synth_detail
