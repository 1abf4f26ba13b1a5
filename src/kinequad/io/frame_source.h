#pragma once

#include <string>
#include <vector>

#include "kinequad/core/types.h"
#include "kinequad/io/polygons.h"
#include "kinequad/mesh/triangle_mesh.h"

namespace kinequad {

/// An animated triangle mesh that hands out one frame at a time, so that no stage holds them all.
/// The connectivity is read once and is the same in every frame.
class FrameSource {
public:
    FrameSource() = default;
    FrameSource(const FrameSource&) = delete;
    FrameSource& operator=(const FrameSource&) = delete;
    virtual ~FrameSource() = default;

    /// Triangles of every frame (m x 3).
    virtual const Triangles& triangles() const = 0;
    /// The faces as the input has them, before they were cut into triangles.
    virtual Polygons polygons() const { return make_polygons(triangles()); }
    /// Number of vertices of every frame.
    virtual int vertex_count() const = 0;
    /// Number of frames, at least 1.
    virtual int frame_count() const = 0;
    /// Positions (n x 3) of frame `frame`, 0 <= frame < frame_count(). Safe to call from several
    /// threads at once. Throws `InputError` (file) where the frame cannot be read and (mesh) where
    /// it is not a frame of this sequence, or holds a number that is not finite.
    virtual Positions read_frame(int frame) const = 0;
    /// True where the input brings a rest shape that is no frame (the OBJ beside a point cache).
    virtual bool has_rest_shape() const { return false; }
    /// Positions (n x 3) of the rest shape; only where `has_rest_shape()`.
    virtual Positions read_rest_shape() const { return read_frame(0); }
    /// What a message calls this input, usually its path.
    virtual std::string name() const = 0;
};

/// Throws `InputError` (mesh), naming the frame, where all vertices of `V`, the frame `frame` of
/// `frames`, are in one place: nothing can be measured there relative to its size.
void require_extent(const Positions& V, int frame, const FrameSource& frames);

/// `most` of `frame_count` frames, evenly chosen from frame 0 on, in ascending order; all of them
/// where there are no more.
std::vector<int> evenly_chosen_frames(int frame_count, int most);

}  // namespace kinequad
