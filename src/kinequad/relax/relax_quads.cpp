#include "kinequad/relax/relax_quads.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "kinequad/mesh/trace_geodesic.h"

namespace kinequad {
namespace {

/// Scaled Jacobian below which a corner is pushed open, and how hard.
constexpr double safe_jacobian = 0.4;
constexpr double opening_weight = 4;
/// Moves shorter than this share of the quad's size are not worth a try.
constexpr double least_move = 0.01;

using Corners = std::array<Vector3, 4>;

/// Normal of a quad by its diagonals, not normalised.
Vector3 area_normal(const Corners& p) { return (p[2] - p[0]).cross(p[3] - p[1]); }

/// Sum over the corners of squared cosines, plus the barrier against folding.
double quad_cost(const Corners& p) {
    const Vector3 normal = area_normal(p).normalized();
    std::array<Vector3, 4> edge;
    std::array<double, 4> inverse_length{};
    for (std::size_t k = 0; k < 4; ++k) {
        edge[k] = p[(k + 1) % 4] - p[k];
        inverse_length[k] = 1 / std::max(edge[k].norm(), 1e-300);
    }
    double sum = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        const Vector3& out = edge[k];
        const Vector3& in = edge[(k + 3) % 4];
        const double scale = inverse_length[k] * inverse_length[(k + 3) % 4];
        const double cosine = out.dot(in) * scale;
        const double jacobian = in.cross(out).dot(normal) * scale;
        sum += cosine * cosine;
        if (jacobian < safe_jacobian) {
            sum += opening_weight * (safe_jacobian - jacobian) * (safe_jacobian - jacobian);
        }
    }
    return sum;
}

/// Where corner `corner` would lie if the quad were the square that fits it best in the plane across
/// `normal` (unit).
Vector3 square_corner(const Corners& p, const Vector3& normal, std::size_t corner) {
    const Vector3 centre = (p[0] + p[1] + p[2] + p[3]) / 4;
    Vector3 spoke = Vector3::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
        // Turn every corner back onto the place of `corner` by quarter turns about the normal.
        Vector3 r = p[k] - centre;
        r -= r.dot(normal) * normal;
        switch ((k + 4 - corner) % 4) {
            case 1:
                r = -normal.cross(r);
                break;
            case 2:
                r = -r;
                break;
            case 3:
                r = normal.cross(r).eval();
                break;
            default:
                break;
        }
        spoke += r / 4;
    }
    return centre + spoke;
}

/// A frame of the input that is looked at, and the quad vertices in it.
struct SampledFrame {
    Positions input;
    Positions quads;
    double weight = 1;
};

class Relaxation {
public:
    Relaxation(const QuadMesh& quads, const Topology& topology, const IntrinsicMetric& metric,
               const Triangles& F, std::vector<SampledFrame> frames)
        : result_(quads), topology_(topology), metric_(metric), F_(F), frames_(std::move(frames)) {
        link_corners();
        for (SampledFrame& frame : frames_) {
            frame.quads.resize(static_cast<Eigen::Index>(quads.vertex.size()), 3);
            for (std::size_t v = 0; v < quads.vertex.size(); ++v) {
                frame.quads.row(static_cast<Eigen::Index>(v)) =
                    position_of(quads.vertex[v], frame.input, F_).transpose();
            }
        }
    }

    /// One pass over the vertices; returns the number of moves.
    int pass(const Context& context) {
        int moves = 0;
        for (int v = 0; v < static_cast<int>(result_.vertex.size()); ++v) {
            if (v % 512 == 0) context.check_cancelled();
            if (!is_fixed_[static_cast<std::size_t>(v)]) moves += improve(v) ? 1 : 0;
        }
        return moves;
    }

    QuadMesh result() const { return result_; }

private:
    /// Corner c of quad q as 4q + c.
    void link_corners() {
        const std::size_t count = result_.vertex.size();
        corner_start_.assign(count + 1, 0);
        const int* index = result_.Q.data();
        const auto corners = static_cast<std::size_t>(result_.Q.size());
        for (std::size_t c = 0; c < corners; ++c) ++corner_start_[static_cast<std::size_t>(index[c]) + 1];
        for (std::size_t v = 0; v < count; ++v) corner_start_[v + 1] += corner_start_[v];
        corner_.resize(corners);
        std::vector<int> next(corner_start_.begin(), corner_start_.end() - 1);
        for (std::size_t c = 0; c < corners; ++c) {
            corner_[static_cast<std::size_t>(next[static_cast<std::size_t>(index[c])]++)] = static_cast<int>(c);
        }
        fix_boundary();
    }

    /// A vertex is interior where the quads around it close up: each neighbour is left once and reached once.
    void fix_boundary() {
        is_fixed_.assign(result_.vertex.size(), 0);
        std::vector<int> balance(result_.vertex.size(), 0);
        for (int v = 0; v < static_cast<int>(result_.vertex.size()); ++v) {
            for (const int c : corners_of(v)) {
                balance[at(neighbour(c, 1))] += 1;
                balance[at(neighbour(c, 3))] -= 1;
            }
            for (const int c : corners_of(v)) {
                for (const int k : {1, 3}) {
                    int& left = balance[at(neighbour(c, k))];
                    if (left != 0) is_fixed_[at(v)] = 1;
                    left = 0;
                }
            }
        }
    }

    static std::size_t at(int i) { return static_cast<std::size_t>(i); }

    struct Range {
        const int* first;
        const int* last;
        const int* begin() const { return first; }
        const int* end() const { return last; }
    };
    Range corners_of(int v) const {
        return {corner_.data() + corner_start_[at(v)], corner_.data() + corner_start_[at(v) + 1]};
    }
    int neighbour(int corner, int k) const { return result_.Q.data()[(corner & ~3) + ((corner + k) & 3)]; }

    Corners corners_in(const SampledFrame& frame, int quad) const {
        Corners p;
        for (std::size_t k = 0; k < 4; ++k) {
            p[k] = frame.quads.row(result_.Q(quad, static_cast<Eigen::Index>(k))).transpose();
        }
        return p;
    }

    double cost_around(int v) const {
        double sum = 0;
        for (const SampledFrame& frame : frames_) {
            for (const int c : corners_of(v)) sum += frame.weight * quad_cost(corners_in(frame, c / 4));
        }
        return sum;
    }

    /// Where vertex `v` should go, as a vector in the frame of its triangle: the least-squares answer to what
    /// the frames ask for.
    Vector2 wanted_move(int v) const {
        const SurfacePoint& point = result_.vertex[at(v)];
        const auto layout = lay_out_triangle(side_lengths(topology_, metric_, point.triangle));
        Eigen::Matrix2d sides;
        sides << layout.col(1) - layout.col(0), layout.col(2) - layout.col(0);
        const Eigen::Matrix2d to_sides = sides.inverse();
        Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();
        Vector2 right = Vector2::Zero();
        const auto triangle = F_.row(point.triangle);
        for (const SampledFrame& frame : frames_) {
            Eigen::Matrix<double, 3, 2> embedding;
            embedding.col(0) = (frame.input.row(triangle[1]) - frame.input.row(triangle[0])).transpose();
            embedding.col(1) = (frame.input.row(triangle[2]) - frame.input.row(triangle[0])).transpose();
            const Vector3 normal = embedding.col(0).cross(embedding.col(1)).normalized();
            const Eigen::Matrix<double, 3, 2> gradient = embedding * to_sides;
            const Vector3 here = frame.quads.row(v).transpose();
            Vector3 move = Vector3::Zero();
            int count = 0;
            for (const int c : corners_of(v)) {
                const Corners p = corners_in(frame, c / 4);
                Vector3 plane = area_normal(p).normalized();
                // A folded quad is judged from the side of the surface.
                if (!(plane.dot(normal) > 0)) plane = normal;
                move += square_corner(p, plane, static_cast<std::size_t>(c & 3)) - here;
                ++count;
            }
            matrix += frame.weight * gradient.transpose() * gradient;
            right += frame.weight * gradient.transpose() * (move / count);
        }
        return matrix.inverse() * right;
    }

    bool improve(int v) {
        const Vector2 move = wanted_move(v);
        const SurfacePoint before = result_.vertex[at(v)];
        const double size =
            (frames_[0].quads.row(neighbour(*corners_of(v).begin(), 1)) - frames_[0].quads.row(v)).norm();
        if (!move.allFinite() || move.norm() < least_move * size) return false;
        const double cost_before = cost_around(v);
        for (const double length : {1.0, 0.4}) {
            place(v, trace_geodesic(topology_, metric_, before, length * move));
            if (cost_around(v) < cost_before) return true;
        }
        place(v, before);
        return false;
    }

    void place(int v, const SurfacePoint& point) {
        result_.vertex[at(v)] = point;
        for (SampledFrame& frame : frames_) {
            frame.quads.row(v) = position_of(point, frame.input, F_).transpose();
        }
    }

    QuadMesh result_;
    const Topology& topology_;
    const IntrinsicMetric& metric_;
    const Triangles& F_;
    std::vector<SampledFrame> frames_;
    std::vector<int> corner_start_;
    std::vector<int> corner_;
    std::vector<char> is_fixed_;
};

std::vector<SampledFrame> sample_frames(const FrameSource& source, const RelaxOptions& options) {
    const int frames = source.frame_count();
    const int wanted = std::clamp(options.sampled_frames, 1, frames);
    std::vector<SampledFrame> sampled;
    SampledFrame reference;
    reference.input = options.reference_is_rest_shape ? source.read_rest_shape()
                                                      : source.read_frame(options.reference_frame);
    reference.weight = std::max(1, wanted - 1);
    sampled.push_back(std::move(reference));
    for (int i = 1; i < wanted; ++i) {
        const int frame = static_cast<int>((static_cast<long>(i) * frames) / wanted);
        if (!options.reference_is_rest_shape && frame == options.reference_frame) continue;
        SampledFrame other;
        other.input = source.read_frame(frame);
        sampled.push_back(std::move(other));
    }
    return sampled;
}

}  // namespace

QuadMesh relax_quads(const QuadMesh& quads, const FrameSource& source, const Topology& topology,
                     const IntrinsicMetric& metric, const RelaxOptions& options, const Context& context) {
    Relaxation relaxation(quads, topology, metric, source.triangles(), sample_frames(source, options));
    for (int round = 0; round < options.rounds; ++round) {
        context.report_progress("relaxation", static_cast<double>(round) / options.rounds);
        if (relaxation.pass(context) == 0) break;
    }
    context.report_progress("relaxation", 1);
    return relaxation.result();
}

}  // namespace kinequad
