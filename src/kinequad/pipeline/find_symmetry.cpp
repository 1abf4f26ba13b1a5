#include "kinequad/pipeline/find_symmetry.h"

#include <fmt/format.h>

#include "kinequad/core/error.h"
#include "kinequad/symmetry/compute_mirror_map.h"
#include "kinequad/symmetry/compute_symmetry_map.h"
#include "kinequad/symmetry/find_mirror_plane.h"

namespace kinequad {
namespace {

/// Residual of a mirror plane, in percent of the diagonal, up to which a surface of several parts
/// is mirrored part by part: landmarks serve parts only that close up along their seams.
constexpr double nearly_symmetric_percent = 1;

}  // namespace

FoundSymmetry find_symmetry(const FrameSource& source, const IntrinsicMetric& metric,
                            const std::optional<Landmarks>& landmarks, const Positions& reference,
                            const Context& context) {
    TriangleMesh mesh{reference, source.triangles()};
    FoundSymmetry found;
    if (landmarks) {
        found.map = compute_symmetry_map(mesh, metric, *landmarks, {}, context);
        context.write_log(LogLevel::info, "symmetry: from the landmarks");
    } else {
        const bool has_parts =
            count_surface(build_topology(source.triangles(), source.vertex_count())).components > 1;
        const double tolerated = has_parts ? nearly_symmetric_percent : symmetric_pose_percent;
        const std::optional<SymmetricPose> pose = find_symmetric_pose(source, tolerated, context);
        if (!pose) {
            throw InputError(
                InputFault::symmetry,
                fmt::format("{}: no pose that was looked at is its own mirror image within {} % of "
                            "the diagonal; give --landmarks",
                            source.name(), tolerated));
        }
        const double residual = pose->plane.residual_percent;
        const std::string name =
            pose->frame < 0 ? "the rest shape" : fmt::format("frame {}", pose->frame);
        context.write_log(
            LogLevel::info,
            fmt::format("symmetry: {} mirrors in a plane within {:.4f} % of the diagonal", name,
                        residual));
        if (residual > symmetric_pose_percent) {
            context.write_log(LogLevel::warning,
                              fmt::format("symmetry: {} is not quite symmetric ({:.2f} % of the "
                                          "diagonal off); its parts are mirrored one by one",
                                          name, residual));
        }
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
