#pragma once

#include "kinequad/io/frame_source.h"

namespace kinequad {

/// A sequence of one frame: a chosen pose of another sequence, as a run on a single pose sees it.
class SingleFrameSource : public FrameSource {
public:
    /// `source` has to outlive this; `V` (n x 3) are the positions of the pose.
    SingleFrameSource(const FrameSource& source, Positions V) : source_(source), V_(std::move(V)) {}

    const Triangles& triangles() const override { return source_.triangles(); }
    int vertex_count() const override { return source_.vertex_count(); }
    int frame_count() const override { return 1; }
    Positions read_frame(int /*frame*/) const override { return V_; }
    std::string name() const override { return source_.name(); }

private:
    const FrameSource& source_;
    Positions V_;
};

}  // namespace kinequad
