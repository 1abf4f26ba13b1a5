#pragma once

#include <optional>

#include "kinequad/core/context.h"
#include "kinequad/io/frame_source.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {

/// Residual of a mirror plane, in percent of the diagonal, up to which a pose counts as symmetric;
/// farther from it, a map from landmarks is better.
inline constexpr double symmetric_pose_percent = 0.1;

/// A plane that mirrors a shape, approximately.
struct MirrorPlane {
    Vector3 normal = Vector3::UnitX();  ///< unit vector
    double offset = 0;                  ///< the plane is x . normal = offset, in units of the input
    /// Root mean square distance of the mirrored vertices from the surface, in percent of the
    /// bounding-box diagonal.
    double residual_percent = 0;

    Vector3 reflect(const Vector3& p) const { return p - 2 * (p.dot(normal) - offset) * normal; }
};

/// Finds the plane in which `mesh` mirrors best, by symmetric iterated closest points from many
/// starts [Besl and McKay 1992]; always returns one, with its residual; for a flat sheet one across
/// it, not the one it lies in. Throws `InputError` (mesh) where there is no triangle.
MirrorPlane find_mirror_plane(const TriangleMesh& mesh, const Context& context);

/// The plane near `start` in which `mesh` mirrors best, by the same from that start alone. Throws
/// `InputError` (mesh) where there is no triangle.
MirrorPlane refine_mirror_plane(const TriangleMesh& mesh, const MirrorPlane& start,
                                const Context& context);

/// A pose of an animation that a plane mirrors.
struct SymmetricPose {
    TriangleMesh mesh;
    int frame = -1;  ///< -1 for the rest shape
    MirrorPlane plane;
};

/// Looks for a pose whose mirror residual is at most `symmetric_pose_percent`: the rest shape
/// first, then about eight frames spread over the animation. Where there is none, the one of least
/// residual if that is at most `tolerated_percent`, else empty.
std::optional<SymmetricPose> find_symmetric_pose(const FrameSource& frames,
                                                 double tolerated_percent, const Context& context);

}  // namespace kinequad
