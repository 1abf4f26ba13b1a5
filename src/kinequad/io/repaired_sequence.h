#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kinequad/core/context.h"
#include "kinequad/io/frame_source.h"
#include "kinequad/mesh/repair_mesh.h"

namespace kinequad {

/// A sequence whose mesh was mended, all frames alike. Vertices keep the numbers that they have in
/// the input, copies come after the last, so that landmarks still name the same points.
class RepairedSequence : public FrameSource {
public:
    /// `source` has to outlive this. Reads every frame once, and the rest shape, to see which
    /// triangles have no area in any. docs/robustness.md
    RepairedSequence(const FrameSource& source, const Context& context);

    const Triangles& triangles() const override { return repair_.F; }
    int vertex_count() const override {
        return source_.vertex_count() + static_cast<int>(repair_.copied_vertices.size());
    }
    int frame_count() const override { return source_.frame_count(); }
    Positions read_frame(int frame) const override { return extend(source_.read_frame(frame)); }
    bool has_rest_shape() const override { return source_.has_rest_shape(); }
    Positions read_rest_shape() const override { return extend(source_.read_rest_shape()); }
    std::string name() const override { return source_.name(); }

    /// One line for everything that was mended.
    const std::vector<std::string>& actions() const { return repair_.actions; }
    /// The triangles over the vertices of the input, without copies.
    Triangles input_triangles() const;

private:
    Positions extend(Positions V) const;

    const FrameSource& source_;
    MeshRepair repair_;
};

}  // namespace kinequad
