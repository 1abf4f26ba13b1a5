#include "kinequad/io/frame_source.h"

#include <fmt/format.h>

#include "kinequad/core/error.h"

namespace kinequad {

void require_extent(const Positions& V, int frame, const FrameSource& frames) {
    if (bounding_box_diagonal(V) > 0) return;
    throw InputError(InputFault::mesh,
                     fmt::format("{}: in frame {} all vertices are in one place; leave it out",
                                 frames.name(), frame));
}

}  // namespace kinequad
