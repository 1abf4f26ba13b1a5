#include "kinequad/io/memory_sequence.h"

#include <fmt/format.h>

#include <utility>

#include "kinequad/core/error.h"

namespace kinequad {

MemorySequence::MemorySequence(Triangles F, std::vector<Positions> frames,
                               std::optional<Positions> rest, std::string name)
    : triangles_(std::move(F)),
      frames_(std::move(frames)),
      rest_(std::move(rest)),
      name_(std::move(name)) {
    const auto fail = [&](const std::string& what) {
        throw InputError(InputFault::mesh, fmt::format("{}: {}", name_, what));
    };
    if (frames_.empty()) fail("has no frames; at least one is needed");
    const Eigen::Index n = frames_.front().rows();
    if (rest_ && rest_->rows() != n) {
        fail(fmt::format("its rest shape has {} vertices, its frames have {}", rest_->rows(), n));
    }
    if (rest_ && !rest_->allFinite()) fail("its rest shape has a position that is not finite");
    for (std::size_t f = 0; f < frames_.size(); ++f) {
        if (frames_[f].rows() != n) {
            fail(fmt::format("frame {} has {} vertices, frame 0 has {}", f, frames_[f].rows(), n));
        }
        if (!frames_[f].allFinite())
            fail(fmt::format("frame {} has a position that is not finite", f));
    }
    if (triangles_.rows() == 0) fail("has no triangles");
    for (Eigen::Index t = 0; t < triangles_.rows(); ++t) {
        if (triangles_.row(t).minCoeff() >= 0 && triangles_.row(t).maxCoeff() < n) continue;
        fail(fmt::format("triangle {} names a vertex that does not exist", t));
    }
}

}  // namespace kinequad
