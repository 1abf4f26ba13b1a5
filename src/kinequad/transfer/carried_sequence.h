#pragma once

#include <vector>

#include "kinequad/io/frame_source.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {

/// A sequence whose vertices are points of the surface of another one, and follow it from frame to
/// frame: a refinement of its triangles, a part of them, or their mirror image on its other side.
class CarriedSequence : public FrameSource {
public:
    /// Triangles `F` (m' x 3) over `points` of the surface of `source` (n'), one a vertex; a point
    /// of no triangle (-1) may be anywhere. With `is_mirrored` space is reflected (x to -x): the
    /// mirror image of a part of a surface keeps the orientation of its triangles so. `source` has
    /// to outlive this.
    CarriedSequence(const FrameSource& source, Triangles F, std::vector<SurfacePoint> points,
                    bool is_mirrored = false);

    const Triangles& triangles() const override { return triangles_; }
    int vertex_count() const override { return static_cast<int>(points_.size()); }
    int frame_count() const override { return source_.frame_count(); }
    Positions read_frame(int frame) const override { return carry(source_.read_frame(frame)); }
    bool has_rest_shape() const override { return source_.has_rest_shape(); }
    Positions read_rest_shape() const override { return carry(source_.read_rest_shape()); }
    std::string name() const override { return source_.name(); }

    /// Positions (n' x 3) of the points where the vertices of the source are at `V` (n x 3).
    Positions carry(const Positions& V) const;

private:
    const FrameSource& source_;
    Triangles triangles_;
    std::vector<SurfacePoint> points_;
    bool is_mirrored_;
};

}  // namespace kinequad
