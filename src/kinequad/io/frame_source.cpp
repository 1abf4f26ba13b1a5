#include "kinequad/io/frame_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "kinequad/core/error.h"
#include "kinequad/core/index.h"

namespace kinequad {

void require_extent(const Positions& V, int frame, const FrameSource& frames) {
    if (bounding_box_diagonal(V) > 0) return;
    throw InputError(InputFault::mesh,
                     fmt::format("{}: in frame {} all vertices are in one place; leave it out",
                                 frames.name(), frame));
}

std::vector<int> evenly_chosen_frames(int frame_count, int most) {
    const int count = std::clamp(most, 0, frame_count);
    std::vector<int> frames;
    frames.reserve(at(count));
    for (std::int64_t i = 0; i < count; ++i) {
        frames.push_back(static_cast<int>(i * frame_count / count));
    }
    return frames;
}

}  // namespace kinequad
