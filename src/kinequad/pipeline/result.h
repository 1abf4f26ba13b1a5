#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinequad/deformation/deformation_tensors.h"
#include "kinequad/extract/quad_mesh.h"
#include "kinequad/field/cross_field.h"
#include "kinequad/gridmap/grid_map.h"
#include "kinequad/mesh/refined_mesh.h"
#include "kinequad/mesh/topology.h"
#include "kinequad/pipeline/domain.h"
#include "kinequad/pipeline/find_symmetry.h"
#include "kinequad/pipeline/options.h"
#include "kinequad/pipeline/stage_clock.h"

namespace kinequad {

/// What every stage of a run made.
struct Result {
    Options options;         ///< as given, with empty fields filled in
    double edge_length = 0;  ///< wanted edge length of the quads, in units of the input
    Topology topology;       ///< of the input
    Positions reference;     ///< n x 3: the input in the reference frame
    /// The input refined, where it is too coarse for the quads; symmetry is then over this.
    std::optional<RefinedMesh> refined;
    std::optional<FoundSymmetry> symmetry;  ///< where the run made use of it
    Domain domain;                          ///< what tensors, field and map are over
    DeformationTensors tensors;
    CrossField field;
    GridMap map;
    QuadMesh quads;  ///< on the input
    /// Where the wanted density was not met, and why; a line each.
    std::vector<std::string> notes;
    std::vector<StageTime> times;  ///< of the stages in the order they ran
};

/// Called after each stage with its name and all that is there so far: to write intermediate
/// results.
using StageObserver = std::function<void(std::string_view stage, const Result& so_far)>;

}  // namespace kinequad
