#include "kinequad/transfer/carried_sequence.h"

#include <utility>

#include "kinequad/transfer/bind_to_surface.h"

namespace kinequad {

CarriedSequence::CarriedSequence(const FrameSource& source, Triangles F,
                                 std::vector<SurfacePoint> points, bool is_mirrored)
    : source_(source),
      triangles_(std::move(F)),
      points_(std::move(points)),
      is_mirrored_(is_mirrored) {
    for (SurfacePoint& point : points_) {
        if (point.triangle < 0) point = {0, Vector3::UnitX()};
    }
}

Positions CarriedSequence::carry(const Positions& V) const {
    Positions X = carried_positions(points_, V, source_.triangles());
    if (is_mirrored_) X.col(0) = -X.col(0);
    return X;
}

}  // namespace kinequad
