// Lines of features that no map can have.
#include <cmath>
#include <numbers>

#include "kinequad/gridmap/charted_mesh.h"

namespace kinequad {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

void give_up(ChartedMesh& mesh, int h) {
    mesh.is_line[at(h)] = mesh.is_line[at(mesh.twin[at(h)])] = 0;
}

/// Quarter turns of the direction `along` of a chart against its first axis.
int quarter(Complex along) {
    return static_cast<int>(std::lround(std::arg(along) / (std::numbers::pi / 2)));
}

/// A line that leaves a vertex, or a side of the boundary there.
struct Ray {
    int half_edge;  ///< -1 for the side of the boundary that comes in
    int quarters;   ///< its direction in the chart of the first triangle of the vertex
    double angle;   ///< from the first half-edge to it
    double length;
};

std::vector<Ray> rays_at(const ChartedMesh& mesh, int start) {
    std::vector<Ray> rays;
    int turns = 0;  // from the first chart to the one here
    double angle = 0;
    for (int h = start;;) {
        const Complex out = mesh.target[at(Topology::next(h))] - mesh.target[at(h)];
        const int in = Topology::previous(h);
        const Complex back = mesh.target[at(in)] - mesh.target[at(h)];
        if (mesh.is_line[at(h)] || mesh.twin[at(h)] < 0)
            rays.push_back({h, quarter(out) - turns, angle, std::abs(out)});
        angle += std::arg(back / out);
        h = mesh.twin[at(in)];
        if (h < 0) {
            rays.push_back({-1, quarter(back) - turns, angle, std::abs(back)});
            return rays;
        }
        turns += mesh.rotation[at(in)];
        if (h != start) continue;
        // Once around: back at the first.
        if (!rays.empty()) {
            Ray last = rays.front();
            last.quarters -= turns;
            last.angle += angle;
            rays.push_back(last);
        }
        return rays;
    }
}

/// Quarter turns of the map between two rays: known up to whole turns, which the angle tells.
int quarters_between(const Ray& from, const Ray& to) {
    const int turned = (to.quarters - from.quarters) & 3;
    const double wanted = (to.angle - from.angle) / (std::numbers::pi / 2);
    return turned + 4 * static_cast<int>(std::lround((wanted - turned) / 4));
}

}  // namespace

int give_up_narrow_lines(ChartedMesh& mesh) {
    const std::vector<int> first = mesh.first_half_edges();
    const auto is_feature = [&](const Ray& ray) {
        return ray.half_edge >= 0 && mesh.twin[at(ray.half_edge)] >= 0 &&
               mesh.is_line[at(ray.half_edge)] == ChartedMesh::feature_line;
    };
    int count = 0;
    for (int v = 0; v < mesh.vertex_count; ++v) {
        if (first[at(v)] < 0) continue;
        for (bool changed = true; changed;) {
            changed = false;
            const std::vector<Ray> rays = rays_at(mesh, first[at(v)]);
            for (std::size_t i = 1; i < rays.size() && !changed; ++i) {
                const Ray& a = rays[i - 1];
                const Ray& b = rays[i];
                if (quarters_between(a, b) > 0 || a.half_edge == b.half_edge) continue;
                const bool first_goes = is_feature(a) && (!is_feature(b) || a.length <= b.length);
                if (!first_goes && !is_feature(b)) continue;
                give_up(mesh, first_goes ? a.half_edge : b.half_edge);
                ++count;
                changed = true;
            }
        }
    }
    return count;
}

int give_up_lines_at(ChartedMesh& mesh, const std::vector<int>& triangles) {
    std::vector<char> is_near(at(mesh.vertex_count), 0);
    for (const int t : triangles) {
        for (int h = 3 * t; h < 3 * t + 3; ++h) is_near[at(mesh.origin[at(h)])] = 1;
    }
    int count = 0;
    for (std::size_t h = 0; h < mesh.origin.size(); ++h) {
        if (mesh.is_line[h] != ChartedMesh::feature_line || !is_near[at(mesh.origin[h])]) continue;
        give_up(mesh, static_cast<int>(h));
        ++count;
    }
    return count;
}

}  // namespace kinequad
