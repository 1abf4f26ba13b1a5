#pragma once

#include <optional>
#include <vector>

#include "kinequad/core/context.h"
#include "kinequad/gridmap/cone_triangulation.h"

namespace kinequad {

/// How many quads there should be.
struct WantedQuads {
    double count = 0;
    double tolerance = 0;  ///< number by which `count` may be missed without trying again
};

/// Whole numbers for the integer unknowns of a map, for which a map without flipped triangles
/// exists.
struct Quantization {
    Eigen::VectorXd integers;  ///< p whole numbers
    double scale = 1;  ///< cells of the real map are to be divided into `scale` cells a side
    double quads = 0;  ///< area of the map in cells
    /// Values of the unknowns on the way from those of the map, times `scale`, to `integers`, which
    /// come last: on straight lines from one to the next no cone runs into another.
    std::vector<Eigen::VectorXd> path;
};

/// Rounds the unknowns of `cone` (in the injective seamless map) so that the energy
/// `(y - s best)^T stiffness (y - s best)` stays low and no cone runs into another, at the scale
/// `s` that gives about as many quads as wanted. docs/gridmap.md, "Whole numbers". Nothing where
/// no scale near it works.
std::optional<Quantization> quantize(const ConeTriangulation& cone,
                                     const Eigen::MatrixXd& stiffness, const Eigen::VectorXd& best,
                                     const WantedQuads& wanted, const Context& context);

}  // namespace kinequad
