#include "kinequad/symmetry/find_mirror_plane.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kinequad/core/parallel.h"
#include "kinequad/mesh/closest_points.h"

namespace kinequad {
namespace {

/// Points of the surface that vote for a plane.
struct Samples {
    std::vector<Vector3> point;
    std::vector<double> weight;  ///< areas, sum 1
};

/// About `count` triangle centres, evenly spread over the numbering, weighted by area.
Samples sample_surface(const TriangleMesh& mesh, int count) {
    Samples samples;
    const Eigen::Index step = std::max<Eigen::Index>(1, mesh.F.rows() / count);
    double sum = 0;
    for (Eigen::Index t = 0; t < mesh.F.rows(); t += step) {
        samples.point.push_back(triangle_centre(mesh.V, mesh.F, t));
        samples.weight.push_back(triangle_area_vector(mesh.V, mesh.F, t).norm());
        sum += samples.weight.back();
    }
    for (double& w : samples.weight) w = sum > 0 ? w / sum : 1.0 / double(samples.weight.size());
    return samples;
}

/// Root mean square distance of the mirrored samples, and the plane that mirrors them best onto
/// their closest points; unless it may be, not the plane that a flat surface lies in.
struct Step {
    double rms = 0;
    MirrorPlane next;
};

Step improve_plane(const ClosestPoints& surface, const Samples& samples, const MirrorPlane& plane,
                   bool may_be_own_plane, std::vector<int>& hints, const Context& context) {
    const std::size_t count = samples.point.size();
    hints.resize(count, -1);
    std::vector<Vector3> closest(count);
    std::vector<double> distance2(count);
    parallel_for(count, 256, context, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const ClosestPoint found = surface.find(plane.reflect(samples.point[i]), hints[i]);
            hints[i] = found.point.triangle;
            distance2[i] = found.squared_distance;
            closest[i] = position_of(found.point, surface.positions(), surface.triangles());
        }
    });
    Vector3 from = Vector3::Zero();
    Vector3 to = Vector3::Zero();
    Step step;
    for (std::size_t i = 0; i < count; ++i) {
        from += samples.weight[i] * samples.point[i];
        to += samples.weight[i] * closest[i];
        step.rms += samples.weight[i] * distance2[i];
    }
    step.rms = std::sqrt(step.rms);
    Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < count; ++i) {
        const Vector3 p = samples.point[i] - from;
        const Eigen::Matrix3d product = p * (closest[i] - to).transpose();
        moment += samples.weight[i] * (product + product.transpose());
        spread += samples.weight[i] * p * p.transpose();
    }
    // |q - reflected p|^2 is least where n^T M n is, as it is for a flat surface in its own plane.
    constexpr double flat = 1e-8;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moment);
    const Vector3 least = solver.eigenvectors().col(0);
    const bool is_own_plane = least.dot(spread * least) < flat * spread.trace();
    step.next.normal =
        is_own_plane && !may_be_own_plane ? Vector3(solver.eigenvectors().col(1)) : least;
    if (step.next.normal.dot(plane.normal) < 0) step.next.normal *= -1;
    step.next.offset = step.next.normal.dot(from + to) / 2;
    return step;
}

/// Normals to start from: the principal axes, and directions spread over the half sphere.
std::vector<Vector3> starting_normals(const Samples& samples, const Vector3& centre) {
    Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < samples.point.size(); ++i) {
        const Vector3 x = samples.point[i] - centre;
        moment += samples.weight[i] * x * x.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moment);
    std::vector<Vector3> normals;
    normals.reserve(3);
    for (int k = 0; k < 3; ++k) normals.emplace_back(solver.eigenvectors().col(k));
    constexpr int spread = 24;
    for (int i = 0; i < spread; ++i) {
        // Fibonacci points of the upper half sphere, turned into the principal frame so that the
        // pose of the input in space plays no part.
        const double height = (i + 0.5) / spread;
        const double angle = i * 2.399963229728653;
        const double radius = std::sqrt(1 - height * height);
        normals.emplace_back(solver.eigenvectors() *
                             Vector3(radius * std::cos(angle), radius * std::sin(angle), height));
    }
    return normals;
}

/// Improves a plane until that gains nothing any more. `percent` is what a length is multiplied by.
MirrorPlane settle_plane(const ClosestPoints& surface, const Samples& samples, MirrorPlane plane,
                         bool may_be_own_plane, double percent, const Context& context) {
    constexpr int most_rounds = 60;
    std::vector<int> hints;
    plane.residual_percent = std::numeric_limits<double>::infinity();
    for (int round = 0; round < most_rounds; ++round) {
        Step step = improve_plane(surface, samples, plane, may_be_own_plane, hints, context);
        const double residual = step.rms * percent;
        const bool is_settled = residual > 0.999 * plane.residual_percent;
        plane.residual_percent = residual;
        if (is_settled || residual < 1e-9 || round == most_rounds - 1) break;
        step.next.residual_percent = residual;
        plane = step.next;
    }
    return plane;
}

MirrorPlane search_plane(const TriangleMesh& mesh, double hopeless_percent,
                         const Context& context) {
    const ClosestPoints surface(mesh.V, mesh.F);
    const double percent = 100 / bounding_box_diagonal(mesh.V);
    const Samples coarse = sample_surface(mesh, 250);
    const Samples fine = sample_surface(mesh, 2500);
    Vector3 centre = Vector3::Zero();
    for (std::size_t i = 0; i < fine.point.size(); ++i) centre += fine.weight[i] * fine.point[i];
    std::vector<std::pair<double, MirrorPlane>> found;
    for (const Vector3& normal : starting_normals(fine, centre)) {
        MirrorPlane plane{normal, normal.dot(centre), 0};
        std::vector<int> hints;
        double rms = 0;
        for (int round = 0; round < 6; ++round) {
            const Step step = improve_plane(surface, coarse, plane, false, hints, context);
            rms = step.rms;
            plane = step.next;
        }
        found.emplace_back(rms * percent, plane);
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    MirrorPlane best = found.front().second;
    best.residual_percent = found.front().first;
    if (best.residual_percent > hopeless_percent) return best;
    bool is_first = true;
    for (std::size_t i = 0; i < 3; ++i) {
        const MirrorPlane plane =
            settle_plane(surface, fine, found[i].second, false, percent, context);
        if (is_first || plane.residual_percent < best.residual_percent) best = plane;
        is_first = false;
        if (best.residual_percent < 0.01) break;
    }
    return best;
}

}  // namespace

MirrorPlane find_mirror_plane(const TriangleMesh& mesh, const Context& context) {
    return search_plane(mesh, 100, context);
}

MirrorPlane refine_mirror_plane(const TriangleMesh& mesh, const MirrorPlane& start,
                                const Context& context) {
    return settle_plane(ClosestPoints(mesh.V, mesh.F), sample_surface(mesh, 2500), start, true,
                        100 / bounding_box_diagonal(mesh.V), context);
}

std::optional<SymmetricPose> find_symmetric_pose(const FrameSource& frames,
                                                 double tolerated_percent, const Context& context) {
    constexpr double hopeless = 10;
    const double tolerated = std::max(tolerated_percent, symmetric_pose_percent);
    std::optional<SymmetricPose> best;
    const auto try_pose = [&](int frame) {
        context.check_cancelled();
        SymmetricPose pose;
        pose.frame = frame;
        pose.mesh = {frame < 0 ? frames.read_rest_shape() : frames.read_frame(frame),
                     frames.triangles()};
        pose.plane = search_plane(pose.mesh, hopeless * tolerated, context);
        const double residual = pose.plane.residual_percent;
        const double least = best ? best->plane.residual_percent : tolerated;
        if (best ? residual < least : residual <= least) best = std::move(pose);
        return residual <= symmetric_pose_percent;
    };
    if (frames.has_rest_shape() && try_pose(-1)) return best;
    const int step = std::max(1, frames.frame_count() / 8);
    for (int frame = 0; frame < frames.frame_count(); frame += step) {
        if (try_pose(frame)) break;
    }
    return best;
}

}  // namespace kinequad
