// Which points of the input are looked at where quads and input are brought together.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "kinequad/core/index.h"
#include "kinequad/relax/gaps.h"

namespace kinequad {
namespace {

/// Between points on edges of the input, in mean lengths of the quads' edges; and how many of those
/// that are close to one another there are at most, over all frames.
constexpr double spacing = 0.7;
constexpr double close_spacing = 0.35;
constexpr std::size_t most_close_points = 3'000'000;

/// Between points inside triangles, in mean lengths of the quads' edges, and how far, in units, a
/// corner or a point of an edge at one is from the quads where there are any.
constexpr double inner_spacing = 0.12;
constexpr double worth_points_inside = 0.7;

/// Edges of the input and sides of its triangles are parted into at most so many pieces, however
/// long they are: fewer where points would be too many otherwise, as of a fine input with a few
/// long edges.
constexpr int most_parts_of_few = 32;
constexpr int most_parts_of_many = 8;

/// Where what is far asks for more points than this, over all frames, there are none but those that
/// are there anyway, so that memory stays within bounds.
constexpr std::size_t most_points = 20'000'000;

}  // namespace

/// All vertices, and points between the ends of edges that are long for the quads: closer to one
/// another where distances count in all frames and there are not too many of them.
void SlidingQuads::Gaps::choose_points() {
    const Topology& topology = sliding_.topology_;
    for (int v = 0; v < topology.vertex_count; ++v) {
        if (topology.vertex_half_edge[at(v)] >= 0) points_.push_back({v, v, v, 0, 0});
    }
    const std::vector<char> all(at(topology.vertex_count), 1);
    const std::size_t vertices = points_.size();
    if (every_frame_counts_) {
        for (const int parts : {most_parts_of_few, most_parts_of_many}) {
            most_parts_ = parts;
            choose_points_on_edges(close_spacing, all);
            if (points_.size() * sliding_.frames_.size() <= most_close_points) return;
            points_.resize(vertices);
        }
    }
    most_parts_ = most_parts_of_many;
    choose_points_on_edges(spacing, all);
    has_close_points_ = false;
}

/// Points where, by what `options` ask for and those before show, others may be the farthest.
void SlidingQuads::Gaps::choose_more_points(const GapOptions& options) {
    if (!every_frame_counts_) return;
    const std::size_t known = points_.size();
    if (!has_close_points_) {
        choose_points_on_edges(close_spacing, vertices_beyond(roughly_near_share / options.limit));
    } else if (options.only_farthest) {
        choose_points_inside(vertices_beyond(worth_points_inside));
    }
    if (points_.size() * sliding_.frames_.size() > most_points) points_.resize(known);
}

/// The vertices (v) that have, or have on an edge of theirs, a point that is farther than
/// `distance` units in some frame.
std::vector<char> SlidingQuads::Gaps::vertices_beyond(double distance) const {
    std::vector<char> is_beyond(at(sliding_.topology_.vertex_count), 0);
    for (std::size_t x = 0; x < points_.size(); ++x) {
        if (!std::any_of(distances_.begin(), distances_.end(), [&](const FrameDistances& here) {
                return here.of_point[x] > distance * here.unit;
            }))
            continue;
        for (const int v : {points_[x].a, points_[x].b}) is_beyond[at(v)] = 1;
    }
    return is_beyond;
}

/// Points that part edges with an end in `is_wanted` (v) into equal pieces of at most `longest`
/// mean lengths of the quads' edges in all frames, but into no more than `most_parts_`.
void SlidingQuads::Gaps::choose_points_on_edges(double longest,
                                                const std::vector<char>& is_wanted) {
    const Topology& topology = sliding_.topology_;
    for (int h = 0; h < 3 * topology.triangle_count; ++h) {
        if (topology.twin[at(h)] > h) continue;
        const int a = sliding_.F_(h / 3, h % 3);
        const int b = sliding_.F_(h / 3, (h + 1) % 3);
        if (!is_wanted[at(a)] && !is_wanted[at(b)]) continue;
        double length = 0;
        for (const Frame& frame : sliding_.frames_) {
            const double here = (frame.input.row(a) - frame.input.row(b)).norm();
            length = std::max(length, here / frame.mean_edge);
        }
        const int parts =
            static_cast<int>(std::min<double>(most_parts_, std::ceil(length / longest)));
        for (int i = 1; i < parts; ++i) {
            points_.push_back({a, b, a, static_cast<double>(i) / parts, 0});
        }
    }
}

/// Points that part triangles with a corner in `is_wanted` (v) into ones with sides of at most
/// `inner_spacing` mean lengths of the quads' edges in all frames, but sides into no more than
/// `most_parts_`.
void SlidingQuads::Gaps::choose_points_inside(const std::vector<char>& is_wanted) {
    const Triangles& F = sliding_.F_;
    for (Eigen::Index t = 0; t < F.rows(); ++t) {
        const std::array corner{F(t, 0), F(t, 1), F(t, 2)};
        if (std::none_of(corner.begin(), corner.end(),
                         [&](int v) { return is_wanted[at(v)] != 0; }))
            continue;
        double longest = 0;
        for (const Frame& frame : sliding_.frames_) {
            for (const auto& [a, b] : {std::pair{0, 1}, {1, 2}, {2, 0}}) {
                const double length =
                    (frame.input.row(corner[at(a)]) - frame.input.row(corner[at(b)])).norm();
                longest = std::max(longest, length / frame.mean_edge);
            }
        }
        const int parts =
            static_cast<int>(std::min<double>(most_parts_, std::ceil(longest / inner_spacing)));
        for (int i = 0; i <= parts; ++i) {
            for (int j = 0; j <= parts - i; ++j) {
                if (i == parts || j == parts || i + j == 0) continue;
                points_.push_back({corner[0], corner[1], corner[2], static_cast<double>(i) / parts,
                                   static_cast<double>(j) / parts});
            }
        }
    }
}

}  // namespace kinequad
