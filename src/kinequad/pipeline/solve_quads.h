#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "kinequad/core/context.h"
#include "kinequad/core/error.h"
#include "kinequad/field/cross_field_targets.h"
#include "kinequad/io/frame_source.h"
#include "kinequad/pipeline/result.h"

namespace kinequad {

/// The lengths that a surface with triangles `topology` is known by: those of the pose `reference`
/// (n x 3), or the mean ones of `frames`, with triangles kept from being flat.
IntrinsicMetric choose_metric(const FrameSource& frames, const Topology& topology,
                              const Positions& reference, MetricChoice choice,
                              const Context& context);

/// An animation of the domain: the frames of its one side, or of the other.
struct DomainView {
    const FrameSource& frames;
    Positions reference;  ///< n' x 3: the pose in which no quad may fold
    /// Of these frames or the reference; what deformation is measured against, so that what is
    /// different between the two sides does not count as deformation.
    IntrinsicMetric metric;
};

/// Called after each stage with its name.
using StageEnd = std::function<void(const char* stage)>;

/// The edges of `mesh`, with triangles `topology`, along the features of the input; `mesh` is over
/// the surface that `run` is solved on, which may itself be refined.
std::vector<int> feature_edges_of(const RefinedMesh& mesh, const Topology& topology,
                                  const Result& run);

/// Measures the deformation of the views of `result.domain`. Fills in `tensors` and the domain's
/// features. Throws as `quadrangulate`.
void measure_deformation(const std::vector<DomainView>& views, Result& result,
                         const Context& context, const StageEnd& finish_stage);

/// Solves the cross field of `result.domain` by `result.options`, a recipe, and verifies it; with
/// the symmetry `field` and `orbits` twice, the second time drawn to the first one's average over
/// the orbits of `result.symmetry`, whose triangles are the domain's then. What crosses are drawn
/// to is `targets`, where given, in place of the deformation. Fills in `field`. Throws as
/// `quadrangulate`.
void solve_field(Result& result, const Context& context,
                 const std::optional<CrossFieldTargets>& targets = std::nullopt);

/// Makes quads of `result.field` over `result.domain`: map and extraction, each verified. Fills in
/// `map`, and `quads` with what is extracted. Returns the quads, whose vertices are points of the
/// domain's triangles. Throws as `quadrangulate`.
QuadMesh map_and_extract(const std::vector<DomainView>& views, Result& result,
                         const Context& context, const StageEnd& finish_stage);

/// Whether another recipe or density may do where this error came from: no map, or a result that
/// failed its verifier.
bool may_be_overcome(const Error& error);

/// Slides the vertices of `quads` over `domain` as `run` asks for, those on its boundary, its curve
/// and `feature_edges` along these, and verifies what comes of it. Throws as `quadrangulate`.
QuadMesh relax_on_domain(const Domain& domain, const std::vector<DomainView>& views,
                         const std::vector<int>& feature_edges, const QuadMesh& quads,
                         const Options& run, const Context& context);

/// Brings quads that `relax_on_domain` has made closer to the input in all frames at last, in the
/// same way and with the same arguments.
QuadMesh settle_on_domain(const Domain& domain, const std::vector<DomainView>& views,
                          const std::vector<int>& feature_edges, const QuadMesh& quads,
                          const Options& run, const Context& context);

}  // namespace kinequad
