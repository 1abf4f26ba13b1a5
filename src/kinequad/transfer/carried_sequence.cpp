#include "kinequad/transfer/carried_sequence.h"

#include <utility>

#include "kinequad/transfer/bind_to_surface.h"

namespace kinequad {

CarriedSequence::CarriedSequence(const FrameSource& source, const RefinedMesh& mesh,
                                 std::vector<SurfacePoint> mirrored)
    : source_(source),
      triangles_(mesh.F),
      points_(vertex_points(mesh)),
      mirrored_(std::move(mirrored)) {
    // A vertex without triangles follows nothing; any place will do.
    for (std::vector<SurfacePoint>* points : {&points_, &mirrored_}) {
        for (SurfacePoint& point : *points) {
            if (point.triangle < 0) point = {0, Vector3::UnitX()};
        }
    }
}

Positions CarriedSequence::carry(const Positions& V, bool is_mirrored) const {
    Positions X =
        carried_positions(is_mirrored ? mirrored_ : points_, V, source_.triangles());
    if (is_mirrored) X.col(0) = -X.col(0);
    return X;
}

Positions CarriedSequence::read_frame(int frame) const {
    const int count = source_.frame_count();
    return carry(source_.read_frame(frame % count), frame >= count);
}

Positions CarriedSequence::read_rest_shape() const {
    return carry(source_.read_rest_shape(), false);
}

}  // namespace kinequad
