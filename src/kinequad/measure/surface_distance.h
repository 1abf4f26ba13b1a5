#pragma once

#include <memory>
#include <vector>

#include "kinequad/core/context.h"
#include "kinequad/mesh/closest_points.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {

/// How densely the distance of two surfaces is sampled. docs/measures.md
struct DistanceOptions {
    /// No point of a surface is farther than this from a sample on it, in percent of the diagonal
    /// of the input's bounding box.
    double spacing_percent = 1;
    /// The spacing is doubled until a surface has at most this many samples inside its triangles.
    int sample_limit = 4'000'000;
    /// The Hausdorff distance is refined where more than this may still be missing: a share of it
    /// plus an absolute part in percent of the diagonal ...
    double relative_tolerance = 0.005;
    double absolute_tolerance_percent = 0.002;
    /// ... with at most this many further samples.
    int refinement_limit = 50'000;
};

/// Distance from the points of one surface to the nearest point of another, in percent of the
/// diagonal of the input's bounding box.
struct DirectedDistance {
    double hausdorff_percent = 0;        ///< largest distance found; the true one is not smaller
    double hausdorff_bound_percent = 0;  ///< the true largest distance is not larger, proven
    double mean_percent = 0;             ///< area-weighted
    double spacing_percent = 0;          ///< of the samples, where the limit allowed no finer ones
    int samples = 0;                     ///< exact point-to-surface distances that were evaluated
};

/// Distance of a quad mesh and the input in one frame.
struct SurfaceDistance {
    DirectedDistance quads_to_input;
    DirectedDistance input_to_quads;

    /// Larger of the two directions.
    double hausdorff_percent() const;
    double hausdorff_bound_percent() const;
    double mean_percent() const;
};

/// What was nearest when a surface was measured last, to make the next frame quick; it changes no
/// result.
struct DistanceHints {
    std::vector<int> vertex;  ///< triangle of the target nearest to each vertex, -1 for unknown
    std::vector<int> center;  ///< the same for a point of each triangle
};

/// Measures a quad mesh against the input frame by frame: what was near in the last frame makes the
/// next one quick, and changes no result. Distances are exact in double precision; the result does
/// not depend on the number of threads.
class SurfaceDistanceMeter {
public:
    /// Throws `InputError` (usage) where the spacing is not positive.
    explicit SurfaceDistanceMeter(DistanceOptions options = {});

    /// Distance of `quads`, cut into triangles, from `input` in the same pose. Several meters may
    /// share one `input`. Throws `InputError` (mesh) where a surface has no triangle, a position is
    /// not finite, or the input has no extent.
    SurfaceDistance measure(const ClosestPoints& input, const TriangleMesh& quads,
                            const Context& context = {});

    /// For every vertex of the quads, the triangle of the input that was nearest to it in the last
    /// `measure`, -1 where no face uses the vertex; empty before the first.
    const std::vector<int>& nearest_input_triangles() const { return quads_hints_.vertex; }

private:
    DistanceOptions options_;
    std::unique_ptr<ClosestPoints> quads_;
    DistanceHints input_hints_;
    DistanceHints quads_hints_;
};

/// Distance of two surfaces in one pose; percentages are of the diagonal of `input`. For a sequence
/// use `SurfaceDistanceMeter`. Throws as its `measure`.
SurfaceDistance measure_distance(const TriangleMesh& input, const TriangleMesh& quads,
                                 const DistanceOptions& options = {}, const Context& context = {});

}  // namespace kinequad
