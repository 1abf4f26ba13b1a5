#include "kinequad/transfer/transfer.h"

namespace kinequad {

Positions quad_positions(const QuadMesh& quads, const Positions& V, const Triangles& F) {
    Positions result(static_cast<Eigen::Index>(quads.vertex.size()), 3);
    for (std::size_t i = 0; i < quads.vertex.size(); ++i) {
        result.row(static_cast<Eigen::Index>(i)) = position_of(quads.vertex[i], V, F).transpose();
    }
    return result;
}

}  // namespace kinequad
