#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "kinequad/extract/quad_mesh.h"
#include "kinequad/io/frame_source.h"
#include "kinequad/measure/measure_sequence.h"
#include "kinequad/pipeline/result.h"

namespace kinequad {

/// The options as in run.json; empty fields of `options` have been filled in.
nlohmann::ordered_json make_options_record(const Options& options);

/// run.json: version, options, input with its digest, what every stage found and took, and the
/// metrics (null where they were not measured). Together with the input it is enough to repeat the
/// run.
nlohmann::ordered_json make_run_record(const Result& result, const FrameSource& source,
                                       const std::string& digest,
                                       const std::optional<SequenceMetrics>& metrics);

/// binding.json: of every quad vertex the triangle of the input and its barycentric coordinates
/// there,
/// `{"triangle": [...], "barycentric": [[b0, b1, b2], ...]}`; `triangles` are those of the input,
/// since polygons were cut. Doubles read back exactly.
std::string format_binding(const QuadMesh& quads, const Triangles& triangles);

/// mirror.json: the mirror vertex of every quad vertex, `{"mirror": [...]}`.
std::string format_mirror(const QuadMesh& quads);

}  // namespace kinequad
