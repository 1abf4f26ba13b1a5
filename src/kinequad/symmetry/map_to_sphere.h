#pragma once

#include "kinequad/core/context.h"
#include "kinequad/mesh/intrinsic_metric.h"
#include "kinequad/symmetry/sphere_points.h"

namespace kinequad {

/// A conformal map of a closed surface to the unit sphere.
struct SphereMap {
    SpherePoints points;         ///< a row for every vertex; isolated ones anywhere
    int reversed_triangles = 0;  ///< triangles that the map turns over
    bool is_uniform = true;      ///< false where only the harmonic fallback gave a map
};

/// Maps a closed surface of genus 0 to the unit sphere by discrete conformal equivalence, with the
/// centre of area in the middle. The surface is punctured where `remoteness` (n, per vertex) is
/// least: at an extremity the limbs opposite would shrink to nothing. Falls back to a harmonic map
/// where that fails. [Haker 2000, Springborn 2020, Baden 2018]
SphereMap map_to_sphere(const Topology& topology, const IntrinsicMetric& metric,
                        const std::vector<double>& remoteness, const Context& context);

/// Moves sphere points by a Moebius transformation, the boost of velocity `beta` along the unit
/// vector `direction`.
void boost_points(SpherePoints& points, const RealVector3& direction, Real beta);

}  // namespace kinequad
