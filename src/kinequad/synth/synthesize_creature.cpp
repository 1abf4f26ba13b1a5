#include "kinequad/synth/synthesize_creature.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"
#include "kinequad/core/parallel.h"
#include "kinequad/mesh/topology.h"
#include "kinequad/synth/half_mesh.h"
#include "kinequad/synth/skinning.h"

namespace kinequad {
namespace {

using namespace synth_detail;

struct NamedCreature {
    std::string_view name;
    Creature (*make)();
};
constexpr std::array<NamedCreature, 2> creatures{
    {{"biped", &make_biped}, {"quadruped", &make_quadruped}}};

Creature creature_named(std::string_view name) {
    for (const NamedCreature& creature : creatures) {
        if (creature.name == name) return creature.make();
    }
    std::string known;
    for (const NamedCreature& creature : creatures) {
        known += (known.empty() ? "" : ", ") + std::string(creature.name);
    }
    throw InputError(InputFault::usage,
                     fmt::format("no creature is called '{}'; choose one of {}", name, known));
}

/// Below this many triangles, grid cells would be as large as limbs: such sizes are made by
/// collapsing edges of a finer mesh.
constexpr int least_gridded = 24000;

int full_count(const HalfMesh& mesh) { return 2 * static_cast<int>(mesh.triangles.size()); }

/// A half mesh of the wanted size, its topology not yet checked.
HalfMesh mesh_half(const ImplicitBody& body, int triangle_count, int attempt,
                   const Context& context) {
    const int gridded = std::max(triangle_count, least_gridded);
    const double shift = 0.37 * attempt;
    // A coarse mesh gives the area, and with it the cell size: their number goes with its square.
    double cell = 0.02;
    HalfMesh mesh = mesh_half_body(body, cell, shift, context);
    for (int step = 0; step < 4; ++step) {
        const double ratio = static_cast<double>(full_count(mesh)) / gridded;
        if (std::abs(ratio - 1) < 0.02) break;
        cell *= std::sqrt(ratio);
        mesh = mesh_half_body(body, cell, shift, context);
    }
    if (triangle_count < gridded) {
        mesh = improve_half_mesh(mesh, body, 2, context);
        mesh = decimate_half_mesh(mesh, body, triangle_count, context);
        return improve_half_mesh(mesh, body, 8, context);
    }
    return improve_half_mesh(mesh, body, 5, context);
}

/// The whole surface: the half, then the mirror images of its vertices off the plane.
struct WholeMesh {
    Positions V;
    Triangles F;
    std::vector<int> mirror;
};

WholeMesh mirror_half(const HalfMesh& half) {
    const auto n = static_cast<int>(half.vertices.size());
    WholeMesh whole;
    whole.mirror.resize(half.vertices.size());
    int next = n;
    for (int v = 0; v < n; ++v) {
        if (half.in_plane[at(v)] != 0) {
            whole.mirror[at(v)] = v;
        } else {
            whole.mirror[at(v)] = next++;
            whole.mirror.push_back(v);
        }
    }
    whole.V.resize(next, 3);
    for (int v = 0; v < next; ++v) {
        const bool other_side = v >= n;
        const int source = other_side ? whole.mirror[at(v)] : v;
        whole.V.row(v) = half.vertices[at(source)].transpose();
        if (other_side) whole.V(v, 0) = -whole.V(v, 0);
    }
    const auto m = static_cast<Eigen::Index>(half.triangles.size());
    whole.F.resize(2 * m, 3);
    for (Eigen::Index t = 0; t < m; ++t) {
        const auto [a, b, c] = half.triangles[at(t)];
        const auto image = [&](int v) { return whole.mirror[at(v)]; };
        whole.F.row(t) << a, b, c;
        whole.F.row(m + t) << image(a), image(c), image(b);
    }
    return whole;
}

bool is_sphere(const WholeMesh& mesh) {
    try {
        const SurfaceCounts counts =
            count_surface(build_topology(mesh.F, static_cast<int>(mesh.V.rows())));
        return counts.components == 1 && counts.boundary_loops == 0 &&
               counts.euler_characteristic == 2 && counts.vertices == mesh.V.rows();
    } catch (const InputError&) {
        return false;
    }
}

/// Grid and triangles with which the surface comes out as a sphere; another place of the grid where
/// it does not.
std::pair<HalfMesh, WholeMesh> mesh_body(const ImplicitBody& body, int triangle_count,
                                         const Context& context) {
    for (int attempt = 0; attempt < 8; ++attempt) {
        std::optional<HalfMesh> half;
        try {
            half = mesh_half(body, triangle_count, attempt, context);
        } catch (const InputError&) {
            continue;
        }
        WholeMesh whole = mirror_half(*half);
        if (is_sphere(whole)) return {std::move(*half), std::move(whole)};
    }
    throw VerificationError(fmt::format(
        "no closed surface of {} triangles came out; ask for another number", triangle_count));
}

int nearest_vertex(const HalfMesh& half, const Vector3& point, bool in_plane) {
    int best = -1;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t v = 0; v < half.vertices.size(); ++v) {
        if ((half.in_plane[v] != 0) != in_plane) continue;
        const double distance = (half.vertices[v] - point).squaredNorm();
        if (distance < least) {
            least = distance;
            best = static_cast<int>(v);
        }
    }
    return best;
}

/// On a coarse mesh two landmarks may fall on one vertex: only the first is kept.
Landmarks find_landmarks(const Creature& creature, const HalfMesh& half,
                         const std::vector<int>& mirror) {
    Landmarks landmarks;
    std::vector<int> taken;
    const auto take = [&](const Vector3& point, bool in_plane) {
        const int vertex = nearest_vertex(half, point, in_plane);
        if (std::find(taken.begin(), taken.end(), vertex) != taken.end()) return -1;
        taken.push_back(vertex);
        return vertex;
    };
    for (const Vector3& point : creature.pair_landmarks) {
        const int left = take(point, false);
        if (left >= 0) {
            landmarks.pairs.push_back({left, mirror[at(left)]});
        }
    }
    for (const Vector3& point : creature.stationary_landmarks) {
        const int vertex = take(point, true);
        if (vertex >= 0) landmarks.stationary.push_back(vertex);
    }
    return landmarks;
}

class SkinnedCreature final : public SyntheticCreature {
public:
    SkinnedCreature(std::string name, Creature creature, const SynthOptions& options,
                    const Context& context)
        : name_(std::move(name)),
          creature_(std::move(creature)),
          frame_count_(options.frame_count),
          context_(context) {
        const ImplicitBody body(creature_);
        auto meshes = mesh_body(body, options.triangle_count, context);
        const HalfMesh half = std::move(meshes.first);
        mesh_ = std::move(meshes.second);
        half_count_ = half.vertices.size();
        weights_.resize(half_count_);
        parallel_for(half_count_, 512, context, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) {
                weights_[v] = body.bone_weights(half.vertices[v]);
            }
        });
        landmarks_ = find_landmarks(creature_, half, mesh_.mirror);
    }

    const Triangles& triangles() const override { return mesh_.F; }
    int vertex_count() const override { return static_cast<int>(mesh_.V.rows()); }
    int frame_count() const override { return frame_count_; }
    bool has_rest_shape() const override { return true; }
    Positions read_rest_shape() const override { return mesh_.V; }
    std::string name() const override { return name_; }
    const std::vector<int>& mirror() const override { return mesh_.mirror; }
    const Landmarks& landmarks() const override { return landmarks_; }

    Positions read_frame(int frame) const override {
        require(frame >= 0 && frame < frame_count_, InputFault::usage,
                "the creature has no frame of this number");
        const Pose pose = creature_.walk(static_cast<double>(frame) / frame_count_);
        const auto motions = bone_motions(creature_, pose);
        Positions V(mesh_.V.rows(), 3);
        parallel_for(static_cast<std::size_t>(V.rows()), 8192, context_,
                     [&](std::size_t begin, std::size_t end) {
                         for (std::size_t v = begin; v < end; ++v) {
                             const auto row = static_cast<Eigen::Index>(v);
                             V.row(row) =
                                 skin_point(mesh_.V.row(row).transpose(), weights_of(v), motions)
                                     .transpose();
                         }
                     });
        return V;
    }

private:
    /// Kept for the half x >= 0 alone; the other half follows the mirror bones.
    BoneWeights weights_of(std::size_t vertex) const {
        if (vertex < half_count_) return weights_[vertex];
        BoneWeights weights = weights_[at(mesh_.mirror[vertex])];
        for (BoneWeight& entry : weights) {
            entry.bone = creature_.bones[at(entry.bone)].mirror;
        }
        return weights;
    }

    std::string name_;
    Creature creature_;
    int frame_count_;
    Context context_;
    WholeMesh mesh_;
    std::size_t half_count_ = 0;
    std::vector<BoneWeights> weights_;
    Landmarks landmarks_;
};

}  // namespace

std::vector<std::string> list_creatures() {
    std::vector<std::string> names;
    names.reserve(std::size(creatures));
    for (const NamedCreature& creature : creatures) names.emplace_back(creature.name);
    return names;
}

std::unique_ptr<SyntheticCreature> synthesize_creature(std::string_view name,
                                                       const SynthOptions& options,
                                                       const Context& context) {
    Creature creature = creature_named(name);
    require(options.triangle_count >= 1000 && options.triangle_count <= 4000000, InputFault::usage,
            "a creature has between 1000 and 4000000 triangles");
    require(options.frame_count >= 1, InputFault::usage, "a creature needs at least one frame");
    return std::make_unique<SkinnedCreature>(std::string(name), std::move(creature), options,
                                             context);
}

}  // namespace kinequad
