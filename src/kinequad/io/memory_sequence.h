#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinequad/io/frame_source.h"

namespace kinequad {

/// A sequence whose frames are all in memory: for shapes made by a program.
class MemorySequence : public FrameSource {
public:
    /// `F` are the m x 3 triangles, `frames` at least one n x 3 array of positions, `rest` an n x 3
    /// array where there is a rest shape. Throws `InputError` (mesh) where the sizes differ, an
    /// index names no vertex or a position is not finite.
    MemorySequence(Triangles F, std::vector<Positions> frames,
                   std::optional<Positions> rest = std::nullopt, std::string name = "sequence");

    const Triangles& triangles() const override { return triangles_; }
    int vertex_count() const override { return static_cast<int>(frames_.front().rows()); }
    int frame_count() const override { return static_cast<int>(frames_.size()); }
    Positions read_frame(int frame) const override {
        return frames_.at(static_cast<std::size_t>(frame));
    }
    bool has_rest_shape() const override { return rest_.has_value(); }
    Positions read_rest_shape() const override { return rest_ ? *rest_ : frames_.front(); }
    std::string name() const override { return name_; }

private:
    Triangles triangles_;
    std::vector<Positions> frames_;
    std::optional<Positions> rest_;
    std::string name_;
};

}  // namespace kinequad
