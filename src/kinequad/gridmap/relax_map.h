#pragma once

#include "kinequad/core/context.h"
#include "kinequad/gridmap/map_system.h"

namespace kinequad {

/// How `bring_to_integers` went.
struct Arrival {
    Eigen::VectorXd x;       ///< values of all columns; no triangle is flipped
    bool arrived = false;    ///< all chain columns have their goal
    std::vector<int> tight;  ///< triangles that held the map back where it has not arrived
};

/// Moves an orientation-keeping map `x` towards the values `goal` of its chain columns, keeping
/// every triangle's area positive: Newton steps on `sum_t A_t energy(J_t)` plus an ever stronger
/// pull. docs/gridmap.md, "Bringing the map to the integers"
Arrival bring_to_integers(const MapVariables& variables, TriangleSystem& system,
                          const std::vector<TargetShape>& shapes, Eigen::VectorXd x,
                          const Eigen::VectorXd& goal, const Context& context);

/// The same along `path`, values of the chain columns of which the last are the goal, one after the
/// other: where the straight way would drag a cone to the wrong side of another. Starts on the way
/// to `path[reached]`, and counts `reached` up.
Arrival follow_path(const MapVariables& variables, TriangleSystem& system,
                    const std::vector<TargetShape>& shapes, Eigen::VectorXd x,
                    const std::vector<Eigen::VectorXd>& path, std::size_t& reached,
                    const Context& context);

/// At most `most_steps` Newton steps on the energy with the chain columns kept.
Eigen::VectorXd relax_map(const MapVariables& variables, TriangleSystem& system,
                          const std::vector<TargetShape>& shapes, Eigen::VectorXd x, int most_steps,
                          const Context& context);

}  // namespace kinequad
