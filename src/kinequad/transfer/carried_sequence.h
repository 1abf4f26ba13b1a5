#pragma once

#include <vector>

#include "kinequad/io/frame_source.h"
#include "kinequad/mesh/refined_mesh.h"

namespace kinequad {

/// A sequence whose vertices are points of the surface of another one, and follow it from frame to
/// frame: a refinement of its triangles, or a part of them. With mirrored points, both sides of a
/// symmetric surface are seen as one: the first half of the frames shows the points, the second
/// half shows the mirrored points in the same frames, reflected in space (x to -x) so that
/// triangles keep their orientation.
class CarriedSequence : public FrameSource {
public:
    /// The triangles and vertices of `mesh`, which refines `source`. `mirrored` is empty or has one
    /// point of the surface of `source` for every vertex of `mesh` (n'). `source` has to outlive
    /// this.
    CarriedSequence(const FrameSource& source, const RefinedMesh& mesh,
                    std::vector<SurfacePoint> mirrored = {});

    const Triangles& triangles() const override { return triangles_; }
    int vertex_count() const override { return static_cast<int>(points_.size()); }
    int frame_count() const override { return source_.frame_count() * (mirrored_.empty() ? 1 : 2); }
    Positions read_frame(int frame) const override;
    bool has_rest_shape() const override { return source_.has_rest_shape(); }
    Positions read_rest_shape() const override;
    std::string name() const override { return source_.name(); }

    /// Positions (n') of the points, or with `is_mirrored` of the mirrored points, reflected, where
    /// the vertices of the source are at `V` (n x 3).
    Positions carry(const Positions& V, bool is_mirrored) const;

private:
    const FrameSource& source_;
    Triangles triangles_;
    std::vector<SurfacePoint> points_;
    std::vector<SurfacePoint> mirrored_;
};

}  // namespace kinequad
