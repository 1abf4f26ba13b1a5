#include "kinequad/pipeline/find_symmetry.h"

#include <fmt/format.h>

#include "kinequad/core/error.h"
#include "kinequad/symmetry/compute_mirror_map.h"
#include "kinequad/symmetry/compute_symmetry_map.h"
#include "kinequad/symmetry/find_mirror_plane.h"

namespace kinequad {
namespace {

/// Residual of a mirror plane, in percent of the diagonal, up to which a pose counts as symmetric.
constexpr double symmetric_pose_percent = 0.1;

}  // namespace

FoundSymmetry find_symmetry(const FrameSource& source, const IntrinsicMetric& metric,
                            const std::optional<Landmarks>& landmarks, const Positions& reference,
                            const Context& context) {
    TriangleMesh mesh{reference, source.triangles()};
    FoundSymmetry found;
    if (landmarks) {
        require_landmarks_fit(*landmarks, source.vertex_count(), source.name());
        found.map = compute_symmetry_map(mesh, metric, *landmarks, {}, context);
        context.write_log(LogLevel::info, "symmetry: from the landmarks");
    } else {
        const std::optional<SymmetricPose> pose =
            find_symmetric_pose(source, symmetric_pose_percent, context);
        if (!pose) {
            throw InputError(
                InputFault::symmetry,
                fmt::format("{}: no pose that was looked at is its own mirror image within {} % of "
                            "the diagonal; give --landmarks",
                            source.name(), symmetric_pose_percent));
        }
        context.write_log(
            LogLevel::info,
            fmt::format("symmetry: {} mirrors in a plane within {:.4f} % of the diagonal",
                        pose->frame < 0 ? "the rest shape" : fmt::format("frame {}", pose->frame),
                        pose->plane.residual_percent));
        mesh = pose->mesh;
        found.map = compute_mirror_map(mesh, pose->plane, metric, context);
    }
    found.report = verify_symmetry_map(mesh, found.map);
    if (!found.report.is_complete) {
        throw VerificationError(fmt::format(
            "the symmetry map is not valid: {}; please report this input", found.report.problem));
    }
    return found;
}

}  // namespace kinequad
