#pragma once

#include <vector>

#include "kinequad/core/context.h"
#include "kinequad/symmetry/find_mirror_plane.h"

namespace kinequad {

/// A motion of space that turns left into right: `p -> linear p + shift`.
struct MirrorMotion {
    Eigen::Matrix3d linear = Eigen::Vector3d(-1, 1, 1).asDiagonal();  ///< orthogonal, det -1
    Vector3 shift = Vector3::Zero();

    Vector3 operator()(const Vector3& p) const { return linear * p + shift; }
    MirrorMotion inverse() const {
        return {linear.transpose(), -(linear.transpose() * shift).eval()};
    }
};

/// The reflection in a plane.
MirrorMotion reflection_in(const MirrorPlane& plane);

/// What a connected part of a surface becomes when it is mirrored.
struct PartMatch {
    int partner = 0;      ///< the part that it falls on; itself where it lies across the plane
    MirrorMotion motion;  ///< takes it there
};

/// The partner of every part of a surface that `plane` mirrors. `parts` lists the triangles of
/// each.
///
/// Where the plane mirrors the surface within `symmetric_pose_percent`, the partner is the part
/// that most triangle centres fall on, and the plane the motion. A pose that is farther from
/// symmetric is mirrored part by part, as figures that are put together of rigid pieces are: parts
/// that choose each other are partners, the others those whose middles mirror most closely, of
/// about the same area, or none; each pair is laid onto one another, and a part that is its own
/// partner onto itself, by iterated closest points [Besl and McKay 1992]. Then partners are mutual,
/// and their motions inverse. docs/symmetry.md
std::vector<PartMatch> match_parts(const TriangleMesh& mesh,
                                   const std::vector<std::vector<int>>& parts,
                                   const MirrorPlane& plane, const Context& context);

}  // namespace kinequad
