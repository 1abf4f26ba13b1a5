#pragma once

#include "kinequad/core/context.h"
#include "kinequad/io/frame_source.h"
#include "kinequad/mesh/intrinsic_metric.h"

namespace kinequad {

/// How far from squares the squares of `from` are in the lengths `to`: the mean over the triangles,
/// weighted by area in `from`, of `(s1^2 - s2^2) / (s1^2 + s2^2)` with the stretches s1 >= s2 from
/// one to the other. 0 where the two are similar, below 1; in radians about the mean deviation of
/// the angles of squares that lie askew to the stretch.
double mean_shear(const Topology& topology, const IntrinsicMetric& from, const IntrinsicMetric& to);

/// What the mean lengths of an animation are worth against those of its reference pose.
struct MetricComparison {
    double gain = 0;  ///< by how much less the frames are sheared against the mean lengths
    double cost = 0;  ///< how much the reference pose is sheared against the mean lengths
};

/// Compares the metrics `mean` and `reference` over at most 24 of `frames`, spread evenly. Throws
/// what `FrameSource::read_frame` throws, and `Cancelled`. docs/deformation.md
MetricComparison compare_metrics(const FrameSource& frames, const Topology& topology,
                                 const IntrinsicMetric& mean, const IntrinsicMetric& reference,
                                 const Context& context);

}  // namespace kinequad
