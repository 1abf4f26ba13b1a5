#pragma once

#include <memory>
#include <string>

#include "kinequad/io/frame_source.h"

namespace kinequad {

/// The axis that points up in the samples of a point cache.
enum class CacheUp {
    as_mesh,  ///< as in the mesh beside the cache: samples are taken as they are
    y,        ///< y in the cache, z in the mesh: (x, y, z) becomes (x, -z, y)
    z,        ///< z in the cache, y in the mesh: (x, y, z) becomes (x, z, -y)
};

/// How a sequence on disk is understood.
struct SequenceOptions {
    CacheUp cache_up = CacheUp::as_mesh;
};

/// Opens an animated mesh on disk. `input` is
/// - a folder of OBJ, PLY or OFF frames, or a glob (* ? [ ]) of such files: the frames in the
/// natural order of
///   their names, all with the same faces;
/// - FILE.obj with FILE.pc2 or FILE.mdd beside it, or FILE.pc2 or FILE.mdd with FILE.obj beside it:
/// the frames are
///   the samples of the cache, the positions of the OBJ are the rest shape; a folder or glob with
///   just these files;
/// - one mesh (OBJ, PLY, OFF, STL): a sequence of one frame.
/// Vertices keep order and number. Polygons are cut into triangles once, as `triangulate_polygons`
/// decides on the OBJ beside a cache or on the first frame. Reads that mesh, and no further frame.
/// Throws `InputError` (file) where files are missing, ambiguous or cannot be parsed, (mesh) where
/// the mesh is not valid or the cache has another number of points. Formats: docs/formats.md.
std::unique_ptr<FrameSource> open_sequence(const std::string& input,
                                           const SequenceOptions& options = {});

}  // namespace kinequad
