#include "kinequad/symmetry/match_parts.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "kinequad/core/index.h"
#include "kinequad/mesh/closest_points.h"

namespace kinequad {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A part by itself.
struct Part {
    std::vector<Vector3> point;  ///< of the surface: corners and triangle centres
    Triangles F;                 ///< over the vertices of the whole
    double area = 0;
    Vector3 middle = Vector3::Zero();
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< principal ones, right-handed
};

Part make_part(const TriangleMesh& mesh, const std::vector<int>& triangles) {
    constexpr std::size_t most_triangles = 1000;
    Part part;
    part.F.resize(static_cast<Eigen::Index>(triangles.size()), 3);
    const std::size_t step = (triangles.size() + most_triangles - 1) / most_triangles;
    // Moments are taken around a corner of the part, so that its place in space does not count.
    const Vector3 origin = mesh.V.row(mesh.F(triangles.front(), 0)).transpose();
    Vector3 sum = Vector3::Zero();
    Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        part.F.row(static_cast<Eigen::Index>(i)) = mesh.F.row(triangles[i]);
        const Vector3 centre = triangle_centre(mesh.V, mesh.F, triangles[i]);
        const double area = triangle_area_vector(mesh.V, mesh.F, triangles[i]).norm() / 2;
        part.area += area;
        sum += area * (centre - origin);
        moment += area * (centre - origin) * (centre - origin).transpose();
        if (i % step != 0) continue;
        part.point.push_back(centre);
        for (const int v : mesh.F.row(triangles[i])) {
            part.point.emplace_back(mesh.V.row(v).transpose());
        }
    }
    if (!(part.area > 0)) {
        for (const Vector3& p : part.point) {
            part.middle += p / static_cast<double>(part.point.size());
        }
        return part;
    }
    const Vector3 offset = sum / part.area;
    part.middle = origin + offset;
    moment = moment / part.area - offset * offset.transpose();
    part.axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moment).eigenvectors();
    if (part.axes.determinant() < 0) part.axes.col(0) *= -1;
    return part;
}

/// The motion nearest to `linear` that turns left into right, with the middle of `from` on that of
/// `to`.
MirrorMotion middle_on_middle(const Eigen::Matrix3d& linear, const Part& from, const Part& to) {
    return {linear, to.middle - linear * from.middle};
}

/// A motion, and how far it leaves the points of a part from where they should be.
struct Fit {
    double mean_square = infinity;
    MirrorMotion motion;
};

/// The motion of least squares that takes `from` onto `to`, point by point.
MirrorMotion best_motion(const std::vector<Vector3>& from, const std::vector<Vector3>& to) {
    Vector3 middle = Vector3::Zero();
    Vector3 goal = Vector3::Zero();
    for (std::size_t i = 0; i < from.size(); ++i) {
        middle += from[i] / static_cast<double>(from.size());
        goal += to[i] / static_cast<double>(from.size());
    }
    Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < from.size(); ++i) {
        moment += (to[i] - goal) * (from[i] - middle).transpose();
    }
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(moment, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Vector3 signs = Vector3::Ones();
    if (svd.matrixU().determinant() * svd.matrixV().determinant() > 0) signs[2] = -1;
    const Eigen::Matrix3d linear = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
    return {linear, goal - linear * middle};
}

double mean_square_distance(const Part& part, const ClosestPoints& target,
                            const MirrorMotion& motion) {
    double sum = 0;
    int hint = -1;
    for (const Vector3& point : part.point) {
        const ClosestPoint found = target.find(motion(point), hint);
        hint = found.point.triangle;
        sum += found.squared_distance;
    }
    return sum / static_cast<double>(part.point.size());
}

/// Iterated closest points from `start`.
Fit lay_onto(const Part& part, const ClosestPoints& target, const MirrorMotion& start,
             const Context& context) {
    constexpr int most_rounds = 60;
    constexpr double least_gain = 1e-4;
    Fit best;
    MirrorMotion motion = start;
    std::vector<int> hints(part.point.size(), -1);
    std::vector<Vector3> goal(part.point.size());
    for (int round = 0; round < most_rounds; ++round) {
        context.check_cancelled();
        double sum = 0;
        for (std::size_t i = 0; i < goal.size(); ++i) {
            const ClosestPoint found = target.find(motion(part.point[i]), hints[i]);
            hints[i] = found.point.triangle;
            goal[i] = position_of(found.point, target.positions(), target.triangles());
            sum += found.squared_distance;
        }
        const double mean_square = sum / static_cast<double>(goal.size());
        const bool is_settled = mean_square >= (1 - least_gain) * best.mean_square;
        if (mean_square < best.mean_square) best = {mean_square, motion};
        if (is_settled || mean_square == 0) break;
        motion = best_motion(part.point, goal);
    }
    return best;
}

/// Whether a part has points on both sides of a plane.
bool lies_across(const Part& part, const MirrorPlane& plane) {
    const auto is_above = [&](const Vector3& p) { return p.dot(plane.normal) > plane.offset; };
    return std::any_of(part.point.begin(), part.point.end(), is_above) &&
           !std::all_of(part.point.begin(), part.point.end(), is_above);
}

/// The reflection of a part in its own plane, near `plane` where it lies across that, else beside
/// it through the middle of the part.
Fit lay_onto_itself(const Part& part, const TriangleMesh& mesh, const MirrorPlane& plane,
                    const Context& context) {
    constexpr double least_cosine = 0.7;
    MirrorPlane start = plane;
    if (!lies_across(part, plane)) start.offset = start.normal.dot(part.middle);
    const MirrorPlane own = refine_mirror_plane({mesh.V, part.F}, start, context);
    // Points that all have the same closest one say nothing about a plane.
    const bool is_near = std::abs(own.normal.dot(plane.normal)) >= least_cosine;
    const MirrorMotion motion = reflection_in(is_near ? own : start);
    return {mean_square_distance(part, ClosestPoints(mesh.V, part.F), motion), motion};
}

/// The motion that lays a part onto its partner: of the best of several starts, the plane's own
/// motion first.
Fit lay_onto_partner(const Part& part, const Part& partner, const TriangleMesh& mesh,
                     const MirrorMotion& mirror, double diagonal, const Context& context) {
    // Where a part is symmetric in itself several motions are as good, and the one that turns it
    // least is meant: another has to be better by more than rounding, and by far.
    constexpr double much_better = 0.25;
    const double rounding = 1e-10 * diagonal * diagonal;
    const ClosestPoints target(mesh.V, partner.F);
    const ClosestPoints origin(mesh.V, part.F);
    std::vector<MirrorMotion> starts = {mirror, middle_on_middle(mirror.linear, part, partner)};
    for (const double x : {1.0, -1.0}) {
        for (const double y : {1.0, -1.0}) {
            // Principal axes on principal axes, an odd number of them reversed.
            const Eigen::Matrix3d turned =
                partner.axes * Vector3(x, y, -x * y).asDiagonal() * part.axes.transpose();
            starts.push_back(middle_on_middle(turned, part, partner));
        }
    }
    Fit best;
    for (const MirrorMotion& start : starts) {
        const Fit there = lay_onto(part, target, start, context);
        // A part that lies on a piece of its partner does not cover it.
        const double back = mean_square_distance(partner, origin, there.motion.inverse());
        const double both = std::max(there.mean_square, back);
        if (both + rounding < much_better * best.mean_square) best = {both, there.motion};
    }
    return best;
}

/// For every part the one that most of its triangle centres fall on.
std::vector<int> vote(const TriangleMesh& mesh, const std::vector<std::vector<int>>& parts,
                      const MirrorPlane& plane, const Context& context) {
    if (parts.size() == 1) return {0};
    std::vector<int> part_of(at(static_cast<int>(mesh.F.rows())));
    for (std::size_t p = 0; p < parts.size(); ++p) {
        for (const int t : parts[p]) part_of[at(t)] = static_cast<int>(p);
    }
    const ClosestPoints all(mesh.V, mesh.F);
    std::vector<int> chosen;
    for (const std::vector<int>& triangles : parts) {
        context.check_cancelled();
        std::vector<int> votes(parts.size(), 0);
        int hint = -1;
        const std::size_t step = std::max<std::size_t>(1, triangles.size() / 500);
        for (std::size_t i = 0; i < triangles.size(); i += step) {
            const Vector3 centre = triangle_centre(mesh.V, mesh.F, triangles[i]);
            hint = all.find(plane.reflect(centre), hint).point.triangle;
            ++votes[at(part_of[at(hint)])];
        }
        const auto most = std::max_element(votes.begin(), votes.end());
        chosen.push_back(static_cast<int>(most - votes.begin()));
    }
    return chosen;
}

/// Keeps choices that are mutual; the other parts are paired, the closest first, where the middle
/// of one mirrors near that of the other and their areas are about the same. What is left stays by
/// itself, and so does what lies across the plane if its middle is closer to its own image.
std::vector<int> make_mutual(const std::vector<int>& chosen, const std::vector<Part>& parts,
                             const MirrorPlane& plane) {
    constexpr double most_difference = 0.3;
    std::vector<int> partner(chosen.size(), -1);
    for (std::size_t p = 0; p < chosen.size(); ++p) {
        if (chosen[at(chosen[p])] == static_cast<int>(p)) partner[p] = chosen[p];
    }
    std::vector<std::tuple<double, int, int>> candidates;
    const auto count = static_cast<int>(parts.size());
    for (int p = 0; p < count; ++p) {
        for (int q = p; q < count; ++q) {
            if (partner[at(p)] >= 0 || partner[at(q)] >= 0) continue;
            const Part& one = parts[at(p)];
            const Part& other = parts[at(q)];
            if (p == q && !lies_across(one, plane)) continue;
            if (std::abs(one.area - other.area) > most_difference * std::max(one.area, other.area))
                continue;
            candidates.emplace_back((plane.reflect(one.middle) - other.middle).norm(), p, q);
        }
    }
    std::sort(candidates.begin(), candidates.end());
    for (const auto& [distance, p, q] : candidates) {
        if (partner[at(p)] >= 0 || partner[at(q)] >= 0) continue;
        partner[at(p)] = q;
        partner[at(q)] = p;
    }
    for (int p = 0; p < count; ++p) {
        if (partner[at(p)] < 0) partner[at(p)] = p;
    }
    return partner;
}

}  // namespace

MirrorMotion reflection_in(const MirrorPlane& plane) {
    return {Eigen::Matrix3d::Identity() - 2 * plane.normal * plane.normal.transpose(),
            2 * plane.offset * plane.normal};
}

std::vector<PartMatch> match_parts(const TriangleMesh& mesh,
                                   const std::vector<std::vector<int>>& parts,
                                   const MirrorPlane& plane, const Context& context) {
    const MirrorMotion mirror = reflection_in(plane);
    const double diagonal = bounding_box_diagonal(mesh.V);
    std::vector<int> partner = vote(mesh, parts, plane, context);
    std::vector<PartMatch> matches;
    matches.reserve(parts.size());
    for (const int p : partner) matches.push_back({p, mirror});
    if (plane.residual_percent <= symmetric_pose_percent || parts.size() == 1) return matches;

    std::vector<Part> alone;
    alone.reserve(parts.size());
    for (const std::vector<int>& triangles : parts) alone.push_back(make_part(mesh, triangles));
    partner = make_mutual(partner, alone, plane);
    for (std::size_t p = 0; p < parts.size(); ++p) {
        context.check_cancelled();
        const std::size_t q = at(partner[p]);
        matches[p].partner = partner[p];
        if (q < p) {
            matches[p].motion = matches[q].motion.inverse();
            continue;
        }
        const Fit fit = q == p
                            ? lay_onto_itself(alone[p], mesh, plane, context)
                            : lay_onto_partner(alone[p], alone[q], mesh, mirror, diagonal, context);
        matches[p].motion = fit.motion;
        context.write_log(
            LogLevel::debug,
            fmt::format(
                "symmetry: the part with triangle {} falls on {} within {:.3f} %", parts[p].front(),
                q == p ? "itself" : fmt::format("the one with triangle {}", parts[q].front()),
                100 * std::sqrt(fit.mean_square) / diagonal));
    }
    return matches;
}

}  // namespace kinequad
