#pragma once

#include <filesystem>
#include <string_view>

#include "kinequad/pipeline/result.h"

namespace kinequad {

/// Writes what the stage `stage` of `quadrangulate` made to `directory`/`stage`.json, for
/// inspection and comparison: names as in the stage's struct, complex numbers as [re, im]. Field
/// and map are over the domain, points of quads and streamlines on the input, the symmetry over the
/// surface that is solved on. Throws `InputError` (file) where the disk refuses,
/// `std::invalid_argument` for a stage that it does not know.
void dump_stage(const std::filesystem::path& directory, std::string_view stage,
                const Result& so_far);

}  // namespace kinequad
