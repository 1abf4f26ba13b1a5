#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "kinequad/core/context.h"
#include "kinequad/io/frame_source.h"
#include "kinequad/mesh/check_mesh.h"

namespace kinequad {

/// Checks the mesh of `source` as at the start of every run and throws `InputError` (mesh) with its
/// name where a run refuses it, naming the elements. `V` (n x 3) is the reference. What a run can
/// do with goes to the log.
void require_valid_input(const FrameSource& source, const Positions& V, const Context& context);

/// The report as text, a line a finding, for people.
std::string format_mesh_report(const MeshReport& report, const std::string& name);

/// The report with all element numbers.
nlohmann::ordered_json make_mesh_record(const MeshReport& report, const std::string& name);

}  // namespace kinequad
