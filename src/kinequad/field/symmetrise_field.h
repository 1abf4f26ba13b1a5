#pragma once

#include "kinequad/core/context.h"
#include "kinequad/field/compute_cross_field.h"
#include "kinequad/field/cross_field.h"
#include "kinequad/field/cross_field_targets.h"
#include "kinequad/mesh/intrinsic_metric.h"
#include "kinequad/symmetry/symmetry_map.h"

namespace kinequad {

/// Averages a cross field over the orbits of a symmetry: what a symmetric field is drawn to.
///
/// The orbit of a triangle are the triangles that share a vertex with it, and those that share one
/// with the triangle that holds the image of its centre. Crosses of the former are carried to the
/// triangle by unfolding, those of the latter to the image triangle and then over by the transport
/// of `map`; all are averaged as fourth powers, weighted by the Gauss function of the distance of
/// their centres from the nearer of the two middle centres, with the largest diameter of all
/// 1-rings as standard deviation. The result has unit values, and `weight` everywhere.
/// [Du and Tu, eq. 10] docs/field.md
CrossFieldTargets average_over_orbits(const Topology& topology, const IntrinsicMetric& metric,
                                      const CrossField& field, const SymmetryMap& map,
                                      double weight, const Context& context);

/// The term that draws every cross to its mirror image in the energy itself. docs/symmetry.md
SymmetryTerm symmetry_term(const SymmetryMap& map, double weight);

/// How symmetric a cross field is.
struct FieldSymmetry {
    /// Mean angle between the cross of a triangle and that of the triangle that holds the image of
    /// its centre, carried over; in degrees, weighted by area. 22.5 for fields that do not care.
    double mean_degrees = 0;
    int singularities = 0;  ///< singular vertices inside that are off the stationary curve
    /// Those of them with another of them, of the same index, within the given distance of their
    /// image.
    int partnered = 0;
};

/// Compares a field with its mirror image. Distances are straight ones in the shape `V` (n x 3),
/// `F` m x 3 triangles; `distance` in units of the input.
FieldSymmetry measure_field_symmetry(const Topology& topology, const IntrinsicMetric& metric,
                                     const CrossField& field, const SymmetryMap& map,
                                     const Positions& V, const Triangles& F, double distance);

}  // namespace kinequad
