#include "kinequad/transfer/transfer.h"

#include "kinequad/transfer/bind_to_surface.h"

namespace kinequad {

Positions quad_positions(const QuadMesh& quads, const Positions& V, const Triangles& F) {
    return carried_positions(quads.vertex, V, F);
}

}  // namespace kinequad
