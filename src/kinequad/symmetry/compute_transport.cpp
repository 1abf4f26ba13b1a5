#include "kinequad/symmetry/compute_transport.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kinequad/core/index.h"
#include "kinequad/core/parallel.h"
#include "kinequad/symmetry/unfold_patch.h"

namespace kinequad {
namespace {

constexpr int patch_limit = 160;

/// Vertices of a patch with their planar positions, each once.
struct PatchVertices {
    std::vector<int> vertex;
    std::vector<Vector2> position;
};

PatchVertices vertices_around(const Topology& topology, const IntrinsicMetric& metric, int t) {
    std::vector<SurfacePoint> beside;
    for (int k = 0; k < 3; ++k) {
        const int g = topology.twin[at(3 * t + k)];
        if (g >= 0) beside.push_back({g / 3, Vector3::Constant(1.0 / 3)});
    }
    const UnfoldedPatch patch = unfold_patch(topology, metric, t, beside, 4);
    PatchVertices result;
    for (std::size_t i = 0; i < patch.triangle.size(); ++i) {
        for (int k = 0; k < 3; ++k) {
            const int v = topology.origin[at(3 * patch.triangle[i] + k)];
            if (std::find(result.vertex.begin(), result.vertex.end(), v) != result.vertex.end()) {
                continue;
            }
            result.vertex.push_back(v);
            result.position.emplace_back(patch.corners[i].col(k));
        }
    }
    return result;
}

struct LocalTransport {
    double angle = 0;
    bool is_known = false;
    bool is_reversed = false;
};

LocalTransport transport_at(const Topology& topology, const IntrinsicMetric& metric,
                            const std::vector<SurfacePoint>& vertex_image, int t,
                            int image_triangle) {
    const PatchVertices here = vertices_around(topology, metric, t);
    std::vector<SurfacePoint> wanted;
    for (const int v : here.vertex) wanted.push_back(vertex_image[at(v)]);
    const UnfoldedPatch there = unfold_patch(topology, metric, image_triangle, wanted, patch_limit);
    std::vector<Vector2> from;
    std::vector<Vector2> to;
    for (std::size_t i = 0; i < here.vertex.size(); ++i) {
        if (!there.is_found[i]) continue;
        from.push_back(here.position[i]);
        to.push_back(there.position[i]);
    }
    LocalTransport result;
    if (from.size() < 3) return result;
    const double share = 1 / static_cast<double>(from.size());
    const Vector2 from_mean = share * std::accumulate(from.begin(), from.end(), Vector2(0, 0));
    const Vector2 to_mean = share * std::accumulate(to.begin(), to.end(), Vector2(0, 0));
    // The nearest reflection in the sense of least squares over the vertices (Procrustes).
    double c = 0;
    double s = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
        const Vector2 x = from[i] - from_mean;
        const Vector2 y = to[i] - to_mean;
        c += y[0] * x[0] - y[1] * x[1];
        s += y[0] * x[1] + y[1] * x[0];
    }
    if (c == 0 && s == 0) return result;
    result.angle = std::atan2(s, c);
    result.is_known = true;
    // The triangle's own corners come first.
    const Vector2 b = to[1] - to[0];
    const Vector2 d = to[2] - to[0];
    result.is_reversed = from.size() == here.vertex.size() && b[0] * d[1] - b[1] * d[0] > 0;
    return result;
}

/// Carries the transport of a neighbour, across half-edge `h`, over to triangle h / 3.
double carry_over(const Topology& topology, const IntrinsicMetric& metric, int h, double neighbour,
                  int image_here, int image_there) {
    const double there_from_here = frame_rotation(topology, metric, h);
    const UnfoldedPatch patch = unfold_patch(
        topology, metric, image_here, {{image_there, Vector3::Constant(1.0 / 3)}}, patch_limit);
    double here_from_there = 0;
    for (std::size_t i = 0; i < patch.triangle.size(); ++i) {
        if (patch.triangle[i] != image_there) continue;
        const Vector2 axis = patch.corners[i].col(1) - patch.corners[i].col(0);
        here_from_there = std::atan2(axis[1], axis[0]);
    }
    return neighbour - there_from_here + here_from_there;
}

/// Gives triangles whose vertices' images lie too far apart the transport of a neighbour.
void fill_unknown(const Topology& topology, const IntrinsicMetric& metric,
                  const std::vector<SurfacePoint>& centre_image,
                  std::vector<LocalTransport>& local) {
    const int count = static_cast<int>(local.size());
    for (bool is_spreading = true; is_spreading;) {
        is_spreading = false;
        const std::vector<LocalTransport> before = local;
        for (int h = 0; h < 3 * count; ++h) {
            const int other = topology.twin[at(h)] / 3;
            if (topology.twin[at(h)] < 0 || other >= count) continue;
            if (local[at(h / 3)].is_known || !before[at(other)].is_known) continue;
            local[at(h / 3)].angle =
                carry_over(topology, metric, h, before[at(other)].angle,
                           centre_image[at(h / 3)].triangle, centre_image[at(other)].triangle);
            local[at(h / 3)].is_known = true;
            is_spreading = true;
        }
    }
}

}  // namespace

Transport compute_transport(const Topology& topology, const IntrinsicMetric& metric,
                            const std::vector<SurfacePoint>& vertex_image,
                            const std::vector<SurfacePoint>& centre_image, const Context& context) {
    Transport transport;
    transport.angle = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(centre_image.size()));
    std::vector<LocalTransport> local(centre_image.size());
    parallel_for(local.size(), 256, context, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            local[t] = transport_at(topology, metric, vertex_image, static_cast<int>(t),
                                    centre_image[t].triangle);
        }
    });
    fill_unknown(topology, metric, centre_image, local);
    for (std::size_t t = 0; t < local.size(); ++t) {
        transport.angle[static_cast<Eigen::Index>(t)] = local[t].angle;
        if (local[t].is_reversed) ++transport.reversed_triangles;
    }
    return transport;
}

}  // namespace kinequad
