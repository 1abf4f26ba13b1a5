#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "kinequad/io/frame_source.h"
#include "kinequad/io/open_sequence.h"

namespace kinequad {

/// A sequence with one mesh file a frame, in the order given (at least one). Reads the first file.
/// Throws as `open_sequence`.
std::unique_ptr<FrameSource> open_mesh_files(std::vector<std::filesystem::path> files,
                                             std::string name);

/// A sequence whose frames are the samples of a PC2 or MDD file and whose faces and rest shape are
/// those of `mesh`. Throws as `open_sequence`.
std::unique_ptr<FrameSource> open_point_cache(const std::filesystem::path& mesh,
                                              const std::filesystem::path& cache,
                                              const SequenceOptions& options);

}  // namespace kinequad
